// SPDX-License-Identifier: Apache-2.0
#include "report/bent_maps.hpp"

#include <cstddef>

#include "grid/parallel.hpp"
#include "gridmerge/merge/fuse.hpp"

namespace gridmerge::internal {

std::vector<std::optional<OccupancyGrid>> bent_maps(const std::vector<OccupancyGrid>& maps,
                                                    const MergeResult& result) {
  std::vector<const Member*> members;
  for (const Component& component : result.components) {
    for (const Member& member : component.members) {
      if (!member.deformation.is_identity()) members.push_back(&member);
    }
  }
  std::vector<std::optional<OccupancyGrid>> bent(maps.size());
  parallel_for(members.size(), [&](std::size_t i) {
    bent[members[i]->map] = bent_map(maps.at(members[i]->map), members[i]->deformation);
  });
  return bent;
}

}  // namespace gridmerge::internal
