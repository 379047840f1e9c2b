// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "bindings.hpp"
#include "gridmerge/merge/merge.hpp"

namespace gridmerge::python {

/// A merge's result with the maps that it is about.
struct Merged {
  std::vector<Map> maps;
  std::shared_ptr<const MergeResult> result;
  std::shared_ptr<const OccupancyGrid> plan = {};  // none if it has none, or was read
};

/// The maps as the engine takes them. Takes long without the interpreter's lock only. Throws Cancelled.
std::vector<OccupancyGrid> grids_of(const std::vector<Map>& maps);

/// x, y [m] and theta [rad] of a map in the world, their standard deviations, and whether it is fixed there.
using Known = std::tuple<Pose, double, double, bool>;

inline std::optional<KnownPose> to_known_pose(const std::optional<Known>& known) {
  if (!known) return std::nullopt;
  const auto& [pose, sd, sd_theta, fixed] = *known;
  return KnownPose{to_se2(pose), sd, sd_theta, fixed};
}

}  // namespace gridmerge::python
