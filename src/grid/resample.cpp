// SPDX-License-Identifier: Apache-2.0
#include "gridmerge/grid/resample.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <vector>

#include "grid/box.hpp"
#include "grid/cell_limit.hpp"
#include "grid/for_each_equal.hpp"
#include "grid/multiversion.hpp"
#include "gridmerge/grid/cancellation.hpp"

namespace gridmerge {

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

OccupancyGrid crop_to_known(const OccupancyGrid& grid) {
  const auto is_known = [](std::uint8_t cell) { return cell != 0; };
  static_assert(static_cast<int>(Cell::unknown) == 0);
  std::vector<std::uint8_t> columns(grid.width, 0);  // 0 where every cell is unknown
  std::vector<std::uint8_t> rows(grid.height, 0);
  for (int row = 0; row < grid.height; ++row) {
    throw_if_cancelled();
    const Cell* cells = grid.cells.data() + grid.index(0, row);
    std::uint8_t any = 0;
    for (int column = 0; column < grid.width; ++column) {  // no branches: vectorised
      const std::uint8_t cell = static_cast<std::uint8_t>(cells[column]);
      columns[column] |= cell;
      any |= cell;
    }
    rows[row] = any;
  }
  int left = 0, right = 0, bottom = 0, top = 0;
  const auto first_known = std::find_if(rows.begin(), rows.end(), is_known);
  if (first_known != rows.end()) {
    bottom = static_cast<int>(first_known - rows.begin());
    top = static_cast<int>(rows.rend() - std::find_if(rows.rbegin(), rows.rend(), is_known)) - 1;
    left = static_cast<int>(std::find_if(columns.begin(), columns.end(), is_known) - columns.begin());
    right = static_cast<int>(columns.rend() - std::find_if(columns.rbegin(), columns.rend(), is_known)) - 1;
  }

  const Point2 corner = grid.origin * Point2{left * grid.resolution, bottom * grid.resolution};
  OccupancyGrid cropped =
      make_grid(right - left + 1, top - bottom + 1, grid.resolution, {corner.x, corner.y, grid.origin.theta});
  if (!grid.probability.empty()) cropped.probability.resize(cropped.cells.size());
  for (int row = 0; row < cropped.height; ++row) {
    throw_if_cancelled();
    const std::size_t from = grid.index(left, bottom + row);
    const std::size_t to = cropped.index(0, row);
    std::copy_n(grid.cells.begin() + from, cropped.width, cropped.cells.begin() + to);
    if (!grid.probability.empty()) {
      std::copy_n(grid.probability.begin() + from, cropped.width, cropped.probability.begin() + to);
    }
  }
  return cropped;
}

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
    internal::for_each_equal(grid.cells.data() + row * width, width, Cell::occupied, [&](std::size_t at) {
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

OccupancyGrid downsample(const OccupancyGrid& grid, int factor) {
  if (factor < 1) throw std::invalid_argument("the downsampling factor must be at least 1");
  OccupancyGrid coarse = make_grid((grid.width - 1) / factor + 1, (grid.height - 1) / factor + 1,
                                   grid.resolution * factor, grid.origin);
  for (int row = 0; row < grid.height; ++row) {
    for (int column = 0; column < grid.width; ++column) {
      Cell& target = coarse.at(column / factor, row / factor);
      target = std::max(target, grid.at(column, row));  // unknown < free < occupied
    }
  }
  return coarse;
}

OccupancyGrid transform_grid(const OccupancyGrid& grid, const SE2& T_target_map, double resolution) {
  if (!std::isfinite(resolution) || resolution <= 0.0)
    throw std::invalid_argument("the resolution must be a positive number of metres");
  const SE2 T_target_grid = T_target_map * grid.origin;
  const double width_m = grid.width * grid.resolution;
  const double height_m = grid.height * grid.resolution;
  internal::Box box;
  for (const Point2& corner :
       std::array<Point2, 4>{{{0, 0}, {width_m, 0}, {0, height_m}, {width_m, height_m}}}) {
    box.add(T_target_grid * corner);
  }
  // The small slack keeps a grid that already fits whole cells from growing by one through rounding.
  const double columns = std::max(1.0, std::ceil((box.max_x - box.min_x) / resolution - 1e-6));
  const double rows = std::max(1.0, std::ceil((box.max_y - box.min_y) / resolution - 1e-6));
  if (!(columns * rows <= internal::kMaxGridCells))
    throw std::invalid_argument("the transformed map would exceed 2^28 cells");

  OccupancyGrid target =
      make_grid(static_cast<int>(columns), static_cast<int>(rows), resolution, {box.min_x, box.min_y, 0.0});
  const SE2 T_grid_target = inverse(T_target_grid);
  const double c = std::cos(T_grid_target.theta) / grid.resolution;
  const double s = std::sin(T_grid_target.theta) / grid.resolution;
  const ManyPointsTransform T_frame_target(target.origin);
  for (int row = 0; row < target.height; ++row) {
    throw_if_cancelled();
    for (int column = 0; column < target.width; ++column) {
      const Point2 p = T_frame_target * Point2{(column + 0.5) * resolution, (row + 0.5) * resolution};
      const double source_x = c * p.x - s * p.y + T_grid_target.x / grid.resolution;
      const double source_y = s * p.x + c * p.y + T_grid_target.y / grid.resolution;
      // Compared before the cast: with a coarse target the centre may be further away than an int can tell.
      const bool inside =
          source_x >= 0.0 && source_x < grid.width && source_y >= 0.0 && source_y < grid.height;
      if (inside) target.at(column, row) = grid.at(static_cast<int>(source_x), static_cast<int>(source_y));
    }
  }
  return target;
}

}  // namespace gridmerge
