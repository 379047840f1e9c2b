// SPDX-License-Identifier: Apache-2.0
// Results of merges to report on, made without a search.
#pragma once

#include <string>
#include <vector>

#include "gridmerge/merge/merge_result.hpp"

namespace gridmerge::test {

/// What merge() would return had it put the maps at these poses: a component for every list of members.
inline MergeResult merged(const std::vector<OccupancyGrid>& maps,
                          const std::vector<std::vector<Member>>& components) {
  MergeResult result;
  std::vector<bool> joined(maps.size(), false);
  for (const std::vector<Member>& members : components) {
    std::vector<PlacedMap> inputs;
    for (const Member& member : members) {
      inputs.push_back({&maps[member.map], member.T_component_map});
      joined[member.map] = true;
    }
    for (std::size_t i = 1; i < members.size(); ++i) {
      Join join;
      join.fixed = members[0].map;
      join.moving = members[i].map;
      join.match.verdict = Verdict::accepted;
      join.match.probability = 0.75;
      join.match.T_fixed_moving = members[i].T_component_map;
      join.outcome = JoinOutcome::accepted;
      static_cast<PairPose&>(join) = join.match;
      result.joins.push_back(join);
    }
    result.components.push_back({members, fuse(inputs, maps[members[0].map].resolution)});
  }
  for (std::size_t i = 0; i < maps.size(); ++i) {
    if (!joined[i]) result.left_out.push_back({i, Reason::nothing_to_compare});
  }
  return result;
}

/// Names that break what takes them for anything but text.
inline const std::vector<std::string> kHostileNames{R"(<script>alert("1")</script>)",
                                                    R"("'><img src=x onerror=alert(1)>&amp;)",
                                                    "\xff\xc3(\xe2\x82<b>",
                                                    "",
                                                    "two\nlines\t\x01",
                                                    "\xe2\x80\xaeover and out",
                                                    "../../{}%s\\",
                                                    std::string(3000, 'a')};

}  // namespace gridmerge::test
