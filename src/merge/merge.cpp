// SPDX-License-Identifier: Apache-2.0
#include "gridmerge/merge/merge.hpp"

#include <stdexcept>
#include <string>

#include "gridmerge/grid/cancellation.hpp"
#include "gridmerge/merge/merger.hpp"

namespace gridmerge {

Merger merger_of(const std::vector<OccupancyGrid>& maps, const MergeOptions& options,
                 const std::vector<std::optional<KnownPose>>& known_poses) {
  if (known_poses.size() > maps.size()) throw std::invalid_argument("there are more known poses than maps");
  Merger merger(options);
  for (std::size_t i = 0; i < maps.size(); ++i) {
    throw_if_cancelled();
    const std::optional<KnownPose> known = i < known_poses.size() ? known_poses[i] : std::nullopt;
    try {
      merger.add(maps[i], known);
    } catch (const std::invalid_argument& error) {
      throw std::invalid_argument("map " + std::to_string(i) + ": " + error.what());
    }
  }
  return merger;
}

MergeResult merge(const std::vector<OccupancyGrid>& maps, const MergeOptions& options,
                  const std::vector<std::optional<KnownPose>>& known_poses) {
  return merger_of(maps, options, known_poses).solve();
}

}  // namespace gridmerge
