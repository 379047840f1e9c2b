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

/// In how many cells a map has another value than the one before; none where they do not have the same cells,
/// as of changed_cells(). O(cells).
std::optional<std::size_t> count_changed_cells(const OccupancyGrid& before, const OccupancyGrid& after);

}  // namespace gridmerge::internal
