// SPDX-License-Identifier: Apache-2.0
// Small maps to draw, and what to look at when they are drawn.
#pragma once

#include <algorithm>
#include <cstdlib>
#include <string>
#include <vector>

#include "gridmerge/grid/occupancy_grid.hpp"
#include "merge/log_odds.hpp"

namespace gridmerge::test {

/// A map from text, top row first: '#' occupied, '.' free, anything else unknown.
inline OccupancyGrid map_from(const std::vector<std::string>& rows, double resolution = 1.0,
                              const SE2& origin = {}) {
  OccupancyGrid map =
      make_grid(static_cast<int>(rows.front().size()), static_cast<int>(rows.size()), resolution, origin);
  for (int row = 0; row < map.height; ++row) {
    for (int column = 0; column < map.width; ++column) {
      const char c = rows[static_cast<std::size_t>(map.height - 1 - row)][static_cast<std::size_t>(column)];
      map.at(column, row) = c == '#' ? Cell::occupied : c == '.' ? Cell::free : Cell::unknown;
    }
  }
  return map;
}

/// The inverse of map_from.
inline std::vector<std::string> text_of(const OccupancyGrid& map) {
  std::vector<std::string> rows;
  for (int row = map.height - 1; row >= 0; --row) {
    std::string text;
    for (int column = 0; column < map.width; ++column) text += " .#"[static_cast<int>(map.at(column, row))];
    rows.push_back(text);
  }
  return rows;
}

/// Draws a line of occupied cells, each a side's or a corner's touch from the next (Bresenham's line).
inline void draw_line(OccupancyGrid& map, int x0, int y0, int x1, int y1) {
  const int steps = std::max(std::abs(x1 - x0), std::abs(y1 - y0));
  for (int i = 0; i <= steps; ++i) {
    const double share = steps == 0 ? 0.0 : static_cast<double>(i) / steps;
    const auto along = [&](int from, int to) { return static_cast<int>(from + share * (to - from) + 0.5); };
    map.at(along(x0, x1), along(y0, y1)) = Cell::occupied;
  }
}

/// How many pieces the occupied cells fall into, cells that touch at a side or a corner being one piece.
inline int count_pieces(int width, int height, const std::vector<bool>& occupied) {
  std::vector<bool> left = occupied;
  int pieces = 0;
  for (std::size_t start = 0; start < left.size(); ++start) {
    if (!left[start]) continue;
    ++pieces;
    std::vector<int> open{static_cast<int>(start)};
    left[start] = false;
    while (!open.empty()) {
      const int column = open.back() % width;
      const int row = open.back() / width;
      open.pop_back();
      for (int y = std::max(0, row - 1); y <= std::min(height - 1, row + 1); ++y) {
        for (int x = std::max(0, column - 1); x <= std::min(width - 1, column + 1); ++x) {
          const int next = y * width + x;
          if (!left[static_cast<std::size_t>(next)]) continue;
          left[static_cast<std::size_t>(next)] = false;
          open.push_back(next);
        }
      }
    }
  }
  return pieces;
}

inline int count_wall_pieces(const OccupancyGrid& map) {
  std::vector<bool> occupied;
  for (const Cell cell : map.cells) occupied.push_back(cell == Cell::occupied);
  return count_pieces(map.width, map.height, occupied);
}

inline int count_wall_pieces(const internal::LogOddsPatch& patch) {
  std::vector<bool> occupied;
  for (const std::int16_t log_odds : patch.log_odds) occupied.push_back(log_odds > 0);
  return count_pieces(patch.width, patch.height, occupied);
}

}  // namespace gridmerge::test
