// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gridmerge/grid/occupancy_grid.hpp"

namespace gridmerge::internal {

/// The map as mappers leave it that clean up after themselves: occupied specks of less than five cells
/// (touching at sides or corners) are free, and every wall is `thicken` metres thicker on each side, over
/// what was free or unknown. Probabilities follow. O(cells * (1 + (thicken / resolution)^2) for walls).
OccupancyGrid tidied(OccupancyGrid map, double thicken);

}  // namespace gridmerge::internal
