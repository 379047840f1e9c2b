// SPDX-License-Identifier: Apache-2.0
#include "grid/quarter_turned.hpp"

#include <algorithm>
#include <cstddef>
#include <numbers>

#include "gridmerge/grid/execution.hpp"

namespace gridmerge::internal {

OccupancyGrid quarter_turned(const OccupancyGrid& grid, int quarters) {
  const int turns = ((quarters % 4) + 4) % 4;
  if (turns == 0) return grid;
  const double width = grid.width * grid.resolution, height = grid.height * grid.resolution;
  // The corner that becomes the lower-left one, in the grid's frame.
  const Point2 corner = turns == 1   ? Point2{0.0, height}
                        : turns == 2 ? Point2{width, height}
                                     : Point2{width, 0.0};
  const Point2 at = grid.origin * corner;
  const double theta = normalize_angle(grid.origin.theta - 0.5 * std::numbers::pi * turns);
  OccupancyGrid turned = turns == 2
                             ? make_grid(grid.width, grid.height, grid.resolution, {at.x, at.y, theta})
                             : make_grid(grid.height, grid.width, grid.resolution, {at.x, at.y, theta});
  if (!grid.probability.empty()) turned.probability.resize(turned.cells.size());
  // From the cell that becomes the first one, to that of the next column, and of the next row.
  const std::ptrdiff_t line = grid.width;
  const std::ptrdiff_t first = turns == 1   ? (grid.height - 1) * line
                               : turns == 2 ? grid.height * line - 1
                                            : line - 1;
  const std::ptrdiff_t along = turns == 1 ? -line : turns == 2 ? -1 : line;
  const std::ptrdiff_t up = turns == 1 ? 1 : turns == 2 ? -line : -1;
  constexpr int kTile = 32;  // cells: what a tile reads stays in the cache until it is read again
  for (int bottom = 0; bottom < turned.height; bottom += kTile) {
    throw_if_cancelled();
    const int top = std::min(bottom + kTile, turned.height);
    for (int left = 0; left < turned.width; left += kTile) {
      const int right = std::min(left + kTile, turned.width);
      for (int row = bottom; row < top; ++row) {
        for (int column = left; column < right; ++column) {
          const std::size_t from = static_cast<std::size_t>(first + column * along + row * up);
          const std::size_t to = turned.index(column, row);
          turned.cells[to] = grid.cells[from];
          if (!grid.probability.empty()) turned.probability[to] = grid.probability[from];
        }
      }
    }
  }
  return turned;
}

}  // namespace gridmerge::internal
