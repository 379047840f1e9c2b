// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <limits>

#include "gridmerge/grid/occupancy_grid.hpp"

namespace gridmerge::test {

/// Of a moving map's walls, those where the fixed one knows something, and of them those that meet a wall.
struct MetWalls {
  int known = 0, met = 0;
};

/// A wall meets another one within `reach` cells of the fixed map, along either axis.
inline MetWalls count_met_walls(const OccupancyGrid& fixed, const OccupancyGrid& moving,
                                const SE2& T_fixed_moving, int reach) {
  MetWalls walls;
  const SE2 T_grid_moving = inverse(fixed.origin) * T_fixed_moving;
  for (int row = 0; row < moving.height; ++row) {
    for (int column = 0; column < moving.width; ++column) {
      if (moving.at(column, row) != Cell::occupied) continue;
      const Point2 p = T_grid_moving * moving.cell_centre(column, row);
      const int x = static_cast<int>(std::floor(p.x / fixed.resolution));
      const int y = static_cast<int>(std::floor(p.y / fixed.resolution));
      if (!fixed.contains(x, y) || fixed.at(x, y) == Cell::unknown) continue;
      ++walls.known;
      bool meets = false;
      for (int dy = -reach; dy <= reach; ++dy) {
        for (int dx = -reach; dx <= reach; ++dx)
          meets = meets || (fixed.contains(x + dx, y + dy) && fixed.at(x + dx, y + dy) == Cell::occupied);
      }
      walls.met += meets ? 1 : 0;
    }
  }
  return walls;
}

/// Their share, of walls that are `near` [m].
inline double walls_met(const OccupancyGrid& fixed, const OccupancyGrid& moving, const SE2& T_fixed_moving,
                        double near) {
  const MetWalls walls =
      count_met_walls(fixed, moving, T_fixed_moving, static_cast<int>(std::ceil(near / fixed.resolution)));
  return walls.known == 0 ? std::numeric_limits<double>::quiet_NaN()
                          : static_cast<double>(walls.met) / walls.known;
}

}  // namespace gridmerge::test
