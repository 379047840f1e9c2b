// SPDX-License-Identifier: Apache-2.0
// What the values of nav_msgs/OccupancyGrid mean. ROS itself is not needed for it.
#pragma once

#include <cstdint>
#include <span>

#include "gridmerge/export.hpp"
#include "gridmerge/grid/occupancy_grid.hpp"
#include "gridmerge/grid/se2.hpp"

namespace gridmerge {

/// A cell of at least this occupancy is occupied, where nothing else is said: nav2's usual occupied_thresh.
inline constexpr double kOccupiedThreshold = 0.65;
/// A cell of at most this occupancy is free, where nothing else is said: nav2's usual free_thresh.
inline constexpr double kFreeThreshold = 0.196;

/// The occupancies at which a cell is occupied or free.
struct OccupancyThresholds {
  double occupied = kOccupiedThreshold;  ///< in [0, 1]
  double free = kFreeThreshold;          ///< in [0, occupied]
};

/// The cell that an occupancy in percent is, as nav2's map files have it in mode `raw`: occupied from
/// `thresholds.occupied` on, free up to `thresholds.free`, else unknown. So is what is no percentage (below 0
/// or above 100).
GRIDMERGE_EXPORT Cell cell_of_percentage(int percentage, const OccupancyThresholds& thresholds = {});

/// An occupancy in percent as a probability in [0, 1]; NaN for what is no percentage.
GRIDMERGE_EXPORT float probability_of_percentage(int percentage);

/// The grid that the values of a message make: width * height percentages, row 0 at the bottom, -1 where
/// unknown. The grid has probabilities if any value is from 1 to 99, so that a map of these three
/// equals the trinary map file of the same content. Throws std::invalid_argument for a grid that validate()
/// refuses. O(cells).
GRIDMERGE_EXPORT OccupancyGrid grid_of_percentages(int width, int height, double resolution,
                                                   const SE2& origin, std::span<const std::int8_t> values);

/// The decimal number that the float was made from [any unit]: 0.05F gives 0.05, not 0.0500000007. Messages
/// have the resolution as a float, map files as a decimal: without this two maps of one resolution would
/// differ in it. NaN and infinities stay.
GRIDMERGE_EXPORT double decimal_of(float value);

/// A rotation as messages have it.
struct Quaternion {
  double x = 0.0;  ///< of the axis, times the sine of half the angle
  double y = 0.0;  ///< as x
  double z = 0.0;  ///< as x
  double w = 1.0;  ///< cosine of half the angle
};

/// What `yaw_of` found a quaternion to be.
enum class Rotation {
  about_z,   ///< a turn about the upward axis
  missing,   ///< four zeros: a message whose author left it as it was made
  tilted,    ///< upward does not stay upward, by more than a twentieth of a degree
  not_unit,  ///< its length is off 1 by more than a thousandth, or is no number
};

/// The turn about the upward axis that a quaternion is.
struct Yaw {
  Rotation kind = Rotation::about_z;  ///< `theta` means something for `about_z` alone
  double theta = 0.0;                 ///< [rad], in (-pi, pi]
};

/// What a quaternion does to a map. A tilt of up to a twentieth of a degree is what is left of a flat pose
/// that went through 32-bit floats.
GRIDMERGE_EXPORT Yaw yaw_of(const Quaternion& rotation);

}  // namespace gridmerge
