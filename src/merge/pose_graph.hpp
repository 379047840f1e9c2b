// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "gridmerge/grid/se2.hpp"
#include "gridmerge/merge/coverage.hpp"

namespace gridmerge {

/// What is measured between two poses.
struct RelativePose {
  std::size_t fixed = 0;   ///< index of a pose
  std::size_t moving = 0;  ///< index of a pose
  SE2 T_fixed_moving;
  Point2 pivot;              ///< in the moving frame, where the measurement is made [m]
  double radius = 1.0;       ///< of what it is made of about the pivot: how much an angle counts [m]
  double sd_position = 1.0;  ///< standard deviation of the displacement [m]
};

/// A pose that was measured between two maps of these extents: in the middle between them, so that it does
/// not matter which of the two is the moving one.
RelativePose measured_between(std::size_t fixed, std::size_t moving, const SE2& T_fixed_moving,
                              const MapExtent& fixed_extent, const MapExtent& moving_extent,
                              double sd_position);

/// The poses nearest to what is measured between them, by robust least squares (Ceres), with the first held.
/// Every pose must be connected with the first.
std::vector<SE2> adjust_poses(std::vector<SE2> poses, const std::vector<RelativePose>& relative);

}  // namespace gridmerge
