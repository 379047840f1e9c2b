// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <random>

#include "gridmerge/grid/occupancy_grid.hpp"

namespace gridmerge::test {

/// Free cells with an unknown rim of ragged width, a few straight walls and some clutter.
inline OccupancyGrid random_grid(unsigned seed, int width, int height, double resolution = 0.1,
                                 const SE2& origin = {}) {
  std::mt19937 random(seed);
  const auto below = [&](int limit) { return static_cast<int>(random() % static_cast<unsigned>(limit)); };
  OccupancyGrid grid = make_grid(width, height, resolution, origin);
  for (int row = 0; row < height; ++row) {
    const int left = below(3);
    const int right = width - below(3);
    for (int column = left; column < right; ++column) grid.at(column, row) = Cell::free;
  }
  for (int wall = 0; wall < 6; ++wall) {
    const bool upright = below(2) == 0;
    const int line = below(upright ? width : height);
    const int from = below(upright ? height : width);
    const int to = std::min(upright ? height : width, from + 5 + below(width));
    for (int i = from; i < to; ++i) grid.at(upright ? line : i, upright ? i : line) = Cell::occupied;
  }
  for (int i = 0; i < width * height / 100; ++i) grid.at(below(width), below(height)) = Cell::occupied;
  return grid;
}

}  // namespace gridmerge::test
