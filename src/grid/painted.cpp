// SPDX-License-Identifier: Apache-2.0
#include "grid/painted.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "grid/for_each_equal.hpp"
#include "grid/multiversion.hpp"
#include "gridmerge/grid/execution.hpp"

namespace gridmerge::internal {

namespace {

/// Cells to the nearest free one of the column, up to `far`, of a row: by what is known of it, and by what is
/// known `before` it of the row beside it.
GRIDMERGE_MULTIVERSION
void reach_from_row(const Cell* cells, const std::uint8_t* before, std::size_t width, std::uint8_t far,
                    std::uint8_t* to_free) {
  for (std::size_t x = 0; x < width; ++x) {
    const std::uint8_t reached = std::min(static_cast<std::uint8_t>(before[x] + 1), far);
    to_free[x] = cells[x] == Cell::free ? std::uint8_t{0} : std::min(to_free[x], reached);
  }
}

}  // namespace

OccupancyGrid without_painted(const OccupancyGrid& grid, double reach) {
  constexpr int kMinReach = 3;
  const int cells = std::clamp(static_cast<int>(std::min(reach / grid.resolution, 250.0)), kMinReach, 250);
  // Cells to the nearest free one of the column, as far as it matters.
  const std::size_t width = static_cast<std::size_t>(grid.width);
  const auto far = static_cast<std::uint8_t>(cells + 1);
  std::vector<std::uint8_t> to_free(grid.cells.size(), far);
  const auto pass = [&](std::size_t row, const std::uint8_t* before) {
    reach_from_row(grid.cells.data() + row * width, before, width, far, to_free.data() + row * width);
  };
  const std::vector<std::uint8_t> none(width, far);
  for (int row = 0; row < grid.height; ++row) {
    throw_if_cancelled();
    pass(row, row == 0 ? none.data() : to_free.data() + (row - 1) * width);
  }
  for (int row = grid.height - 1; row >= 0; --row)
    pass(row, row + 1 == grid.height ? none.data() : to_free.data() + (row + 1) * width);

  std::vector<std::size_t> painted;
  for (int row = 0; row < grid.height; ++row) {
    throw_if_cancelled();
    const std::uint8_t* line = to_free.data() + row * width;
    int nearest_until = -1;  // up to here some cell of the window ahead is known to be near a free one
    for_each_equal(grid.cells.data() + row * width, width, Cell::occupied, [&](std::size_t at) {
      const int column = static_cast<int>(at);
      if (line[column] < far) return;
      const int first = std::max(0, column - cells), last = std::min(grid.width - 1, column + cells);
      if (nearest_until >= first) return;
      bool is_near = false;
      for (int x = last; x >= first && !is_near; --x) {
        is_near = line[x] < far;
        if (is_near) nearest_until = x;
      }
      if (!is_near) painted.push_back(row * width + at);
    });
  }
  if (painted.empty()) return grid;
  OccupancyGrid seen = grid;
  for (const std::size_t cell : painted) {
    seen.cells[cell] = Cell::unknown;
    if (!seen.probability.empty()) seen.probability[cell] = std::numeric_limits<float>::quiet_NaN();
  }
  return seen;
}

bool is_mostly_painted(const OccupancyGrid& grid) {
  const CellCounts counts = count_cells(grid);
  if (2 * counts.occupied <= counts.known())
    return false;  // as of nearly every map: what follows takes longer
  const std::size_t painted = counts.occupied - count_cells(without_painted(grid)).occupied;
  return 2 * painted > counts.known();
}

}  // namespace gridmerge::internal
