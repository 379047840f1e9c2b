// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "building.hpp"
#include "gridmerge/grid/occupancy_grid.hpp"

namespace gridmerge::example {

/// A pose with its heading as a unit vector. As in the building's drawing, no angle is ever taken on the way
/// to a cell.
struct Pose {
  Point2 position;
  Point2 heading{1.0, 0.0};
};

/// A robot's trip through a building. Metres, in the building's frame.
struct Trip {
  Point2 first_heading;       ///< where the robot looks when it is switched on: any length but zero
  std::vector<Point2> stops;  ///< joined by straight legs; the first is where the robot is switched on
  std::uint64_t seed = 0;     ///< of everything that chance decides
};

/// Where a trip's map frame lies: a robot calls the pose in which it is switched on (0, 0, 0).
Pose start_pose(const Trip& trip);

/// The map that a robot with a laser range finder makes on a trip, in its own frame, cropped to what it saw.
/// Throws std::invalid_argument when the trip leads through a wall. O(scans x beams x edges nearby).
OccupancyGrid map_building(const Building& building, const Trip& trip);

}  // namespace gridmerge::example
