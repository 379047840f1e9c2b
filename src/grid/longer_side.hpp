// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

#include "gridmerge/grid/occupancy_grid.hpp"

namespace gridmerge::internal {

/// Of all its cells, known or not [m].
inline double longer_side(const OccupancyGrid& grid) {
  return std::max(grid.width, grid.height) * grid.resolution;
}

}  // namespace gridmerge::internal
