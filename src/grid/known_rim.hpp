// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gridmerge/grid/execution.hpp"
#include "gridmerge/grid/occupancy_grid.hpp"

namespace gridmerge::internal {

/// Calls `use` with the corners, in the map's frame [m], of each known cell at the rim of what is known: one
/// beside which a cell is unknown, or none. However a map is bent, all of it lies within them. O(cells).
template <typename Use>
void for_each_rim_corner(const OccupancyGrid& map, const Use& use) {
  const auto is_known = [&](int column, int row) {
    return map.contains(column, row) && map.at(column, row) != Cell::unknown;
  };
  for (int row = 0; row < map.height; ++row) {
    throw_if_cancelled();
    for (int column = 0; column < map.width; ++column) {
      if (!is_known(column, row)) continue;
      if (is_known(column - 1, row) && is_known(column + 1, row) && is_known(column, row - 1) &&
          is_known(column, row + 1))
        continue;
      for (const int x : {column, column + 1}) {
        for (const int y : {row, row + 1}) use(map.origin * Point2{x * map.resolution, y * map.resolution});
      }
    }
  }
}

}  // namespace gridmerge::internal
