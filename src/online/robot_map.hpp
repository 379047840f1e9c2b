// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>

#include "gridmerge/grid/occupancy_grid.hpp"

namespace gridmerge::internal {

/// How a robot's map differs from another one of the same robot.
struct MapChange {
  double share = 0.0;        ///< of the known cells of either that are not the same in both, in [0, 1]
  bool other_frame = false;  ///< it does not go on from the other one: the robot started anew
};

/// From `before` to `after`, both in the robot's map frame. O(cells).
MapChange change_between(const OccupancyGrid& before, const OccupancyGrid& after);

/// Whether most walls of `before` still stand in `after`, or nearly so: then both maps have one frame, though
/// change_between() may not see that. A map without walls does not speak against it. O(cells).
bool keeps_walls(const OccupancyGrid& before, const OccupancyGrid& after);

/// Cells of a map that have another value than in the map before.
struct ChangedCells {
  std::size_t all = 0;
  std::size_t walls = 0;  ///< of these, occupied in either
};

/// None where the maps do not have the same cells, as of changed_cells(). O(cells).
std::optional<ChangedCells> count_changed_cells(const OccupancyGrid& before, const OccupancyGrid& after);

}  // namespace gridmerge::internal
