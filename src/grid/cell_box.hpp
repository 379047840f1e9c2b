// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>

#include "grid/box.hpp"
#include "gridmerge/grid/occupancy_grid.hpp"

namespace gridmerge::internal {

/// A rectangle of cells.
struct CellBox {
  int left = 0;
  int bottom = 0;
  int right = 0;  ///< one past the last column
  int top = 0;    ///< one past the last row

  int width() const { return right - left; }
  int height() const { return top - bottom; }
  bool empty() const { return width() <= 0 || height() <= 0; }
};

/// The cells of both boxes; empty, but not negative in size, if there are none.
inline CellBox intersect(const CellBox& a, const CellBox& b) {
  CellBox common{std::max(a.left, b.left), std::max(a.bottom, b.bottom), std::min(a.right, b.right),
                 std::min(a.top, b.top)};
  common.right = std::max(common.left, common.right);
  common.top = std::max(common.bottom, common.top);
  return common;
}

/// The smallest box that holds the cells of both; an empty one holds none.
inline CellBox unite(const CellBox& a, const CellBox& b) {
  if (a.empty()) return b;
  if (b.empty()) return a;
  return {std::min(a.left, b.left), std::min(a.bottom, b.bottom), std::max(a.right, b.right),
          std::max(a.top, b.top)};
}

inline CellBox all_cells(const OccupancyGrid& grid) {
  return {0, 0, grid.width, grid.height};
}

/// The cells of one lattice that lie under a box of another one's, and `rim` cells about them; those of
/// `limits` alone. `T_cells_box` takes points of the box's lattice to the other's, both from their lower-left
/// corners [m]; resolutions are sides of cells [m]. O(1).
inline CellBox cells_under(const CellBox& box, double box_resolution, const SE2& T_cells_box,
                           double resolution, int rim, const CellBox& limits) {
  Box under;  // [cells]
  for (const int column : {box.left, box.right}) {
    for (const int row : {box.bottom, box.top}) {
      const Point2 corner = T_cells_box * Point2{column * box_resolution, row * box_resolution};
      under.add(Point2{corner.x / resolution, corner.y / resolution});
    }
  }
  const auto clip = [](double cell, int low, int high) {
    return static_cast<int>(std::clamp<double>(std::floor(cell), low, high));
  };
  return {clip(under.min_x - rim, limits.left, limits.right),
          clip(under.min_y - rim, limits.bottom, limits.top),
          clip(under.max_x + rim + 1, limits.left, limits.right),
          clip(under.max_y + rim + 1, limits.bottom, limits.top)};
}

}  // namespace gridmerge::internal
