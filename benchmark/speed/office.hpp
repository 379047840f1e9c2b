// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gridmerge/grid/occupancy_grid.hpp"

namespace gridmerge::bench {

/// A map to measure on: `side` x `side` cells of 0.05 m, rooms of 4 m with a door in every wall, and `border`
/// unknown cells on every side. Free inside, walls one cell thick.
inline OccupancyGrid make_office(int side, int border) {
  OccupancyGrid grid = make_grid(side, side, 0.05);
  constexpr int kRoom = 80;
  constexpr int kDoor = 18;
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

/// With a border as wide as an eighth of the side, as maps have.
inline OccupancyGrid make_office(int side) {
  return make_office(side, side / 8);
}

/// Without a border: every cell is known, and none can be left out.
inline OccupancyGrid make_full_office(int side) {
  return make_office(side, 0);
}

}  // namespace gridmerge::bench
