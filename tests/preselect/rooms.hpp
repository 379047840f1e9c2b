// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <initializer_list>

#include "gridmerge/grid/occupancy_grid.hpp"

namespace gridmerge::test {

/// What a robot sees of a floor of 16 m x 11 m with six unequal rooms: what lies right of a column.
inline OccupancyGrid rooms_from(int first_column) {
  OccupancyGrid map = make_grid(340 - first_column, 240, 0.05);
  const auto is_line = [](int at, std::initializer_list<int> lines) {
    return std::any_of(lines.begin(), lines.end(), [&](int line) { return at >= line && at < line + 3; });
  };
  for (int row = 10; row < 231; ++row) {
    for (int column = std::max(10, first_column); column < 331; ++column) {
      const bool is_wall = is_line(column, {10, 76, 190, 328}) || is_line(row, {10, 133, 228});
      map.at(column - first_column, row) = is_wall ? Cell::occupied : Cell::free;
    }
  }
  return map;
}

}  // namespace gridmerge::test
