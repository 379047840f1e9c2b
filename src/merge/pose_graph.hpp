// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "gridmerge/grid/se2.hpp"
#include "internal_export.hpp"
#include "merge/map_extent.hpp"

namespace gridmerge::internal {

/// What is measured between two poses.
struct RelativePose {
  std::size_t fixed = 0;   ///< index of a pose
  std::size_t moving = 0;  ///< index of a pose
  SE2 T_fixed_moving;
  Point2 pivot;              ///< in the moving frame, where the measurement is made [m]
  double sd_position = 1.0;  ///< standard deviation of the pivot's place [m]
  double sd_theta = 1.0;     ///< standard deviation of the direction [rad]
};

/// A pose that was measured between two maps of these extents, to a displacement of `sd` metres: in the
/// middle between them, so that it does not matter which of the two is the moving one.
GRIDMERGE_INTERNAL_EXPORT RelativePose measured_between(std::size_t fixed, std::size_t moving,
                                                        const SE2& T_fixed_moving,
                                                        const MapExtent& fixed_extent,
                                                        const MapExtent& moving_extent, double sd);

/// A pose to be adjusted.
struct AdjustablePose {
  SE2 pose;
  Point2 middle;  ///< of what the frame holds
  bool held = false;
};

/// The poses nearest to what is measured between them, by robust least squares; at least one is to be held.
std::vector<SE2> adjust_poses(const std::vector<AdjustablePose>& poses,
                              const std::vector<RelativePose>& measured);

}  // namespace gridmerge::internal
