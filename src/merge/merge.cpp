// SPDX-License-Identifier: Apache-2.0
#include "gridmerge/merge/merge.hpp"

#include "gridmerge/merge/merger.hpp"

namespace gridmerge {

MergeResult merge(const std::vector<OccupancyGrid>& maps, const MergeOptions& options,
                  const std::vector<std::optional<KnownPose>>& known_poses) {
  return merger_of(maps, options, known_poses).solve();
}

}  // namespace gridmerge
