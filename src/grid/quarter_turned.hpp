// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gridmerge/grid/occupancy_grid.hpp"
#include "internal_export.hpp"

namespace gridmerge::internal {

/// The same map with its rows and columns turned by `quarters` quarters of a turn, counter-clockwise; the
/// origin turns back, so points keep their coordinates in the map frame. Nothing is resampled. O(cells).
GRIDMERGE_INTERNAL_EXPORT OccupancyGrid quarter_turned(const OccupancyGrid& grid, int quarters);

}  // namespace gridmerge::internal
