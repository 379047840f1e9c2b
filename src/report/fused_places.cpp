// SPDX-License-Identifier: Apache-2.0
#include "report/fused_places.hpp"

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
  return without_copies(placed);
}

}  // namespace gridmerge::internal
