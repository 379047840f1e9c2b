// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gridmerge/grid/occupancy_grid.hpp"
#include "internal_export.hpp"

namespace gridmerge::internal {

/// Walls are no thicker than this from where they can be seen [m].
inline constexpr double kWallDepth = 0.15;

/// The grid without occupied cells that have no free cell within `reach` metres (at least three cells) of
/// them, measured along rows and along columns: they become unknown. Such cells were never seen by a robot:
/// somebody painted them. O(cells).
GRIDMERGE_INTERNAL_EXPORT OccupancyGrid without_painted(const OccupancyGrid& grid, double reach = kWallDepth);

/// Whether more than half of the known cells are such: all that no robot has seen was painted black.
/// O(cells).
GRIDMERGE_INTERNAL_EXPORT bool is_mostly_painted(const OccupancyGrid& grid);

}  // namespace gridmerge::internal
