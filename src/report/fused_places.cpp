// SPDX-License-Identifier: Apache-2.0
#include "report/fused_places.hpp"

#include <algorithm>
#include <iterator>
#include <memory>
#include <numeric>

#include "match/prepared_map.hpp"
#include "merge/copies.hpp"

namespace gridmerge::internal {

std::vector<std::size_t> fused_places(const MergeResult& merge, std::size_t component,
                                      const std::vector<OccupancyGrid>& maps) {
  const std::vector<Member>& members = merge.components[component].members;
  if (!merge.expected_false_joins) {  // up a tree
    std::vector<std::size_t> all(members.size());
    std::iota(all.begin(), all.end(), std::size_t{0});
    return all;
  }
  std::vector<std::unique_ptr<const PreparedMap>> prepared;
  std::vector<PlacedInput> placed;
  for (const Member& member : members) {
    prepared.push_back(std::make_unique<const PreparedMap>(maps.at(member.map)));
    placed.push_back({prepared.back().get(), member.T_component_map});
  }
  std::vector<std::size_t> places = without_copies(placed);
  // Copies of which both have known poses count each.
  for (const Join& join : merge.joins) {
    if (join.outcome != JoinOutcome::known) continue;
    const auto place_of = [&](std::size_t map) {
      return std::find_if(members.begin(), members.end(),
                          [map](const Member& member) { return member.map == map; }) -
             members.begin();
    };
    const auto fixed = place_of(join.fixed), moving = place_of(join.moving);
    if (std::max(fixed, moving) >= std::ssize(members)) continue;
    if (!is_copy(*prepared[static_cast<std::size_t>(fixed)], *prepared[static_cast<std::size_t>(moving)]))
      continue;
    places.push_back(static_cast<std::size_t>(fixed));
    places.push_back(static_cast<std::size_t>(moving));
  }
  std::sort(places.begin(), places.end());
  places.erase(std::unique(places.begin(), places.end()), places.end());
  return places;
}

}  // namespace gridmerge::internal
