// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gridmerge/grid/occupancy_grid.hpp"

namespace gridmerge::bench {

/// A map to measure on: `side` x `side` cells of 0.05 m, rooms of 4 m with a door in every wall, and a border
/// of unknown cells as wide as an eighth of the side. Free inside, walls one cell thick.
inline OccupancyGrid make_office(int side) {
  OccupancyGrid grid = make_grid(side, side, 0.05);
  constexpr int kRoom = 80;
  constexpr int kDoor = 18;
  const int border = side / 8;
  for (int row = border; row < side - border; ++row) {
    for (int column = border; column < side - border; ++column) {
      const int x = (column - border) % kRoom;
      const int y = (row - border) % kRoom;
      const bool wall = (x == 0 && y >= kDoor) || (y == 0 && x >= kDoor);
      grid.at(column, row) = wall ? Cell::occupied : Cell::free;
    }
  }
  return grid;
}

}  // namespace gridmerge::bench
