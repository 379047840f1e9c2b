// SPDX-License-Identifier: Apache-2.0
#include "gridmerge/grid/resample.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <vector>

#include "grid/box.hpp"
#include "gridmerge/grid/execution.hpp"

namespace gridmerge {

OccupancyGrid crop_to_known(const OccupancyGrid& grid) {
  validate(grid);
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

OccupancyGrid downsample(const OccupancyGrid& grid, int factor) {
  validate(grid);
  if (factor < 1) throw std::invalid_argument("the downsampling factor must be at least 1");
  OccupancyGrid coarse = make_grid((grid.width - 1) / factor + 1, (grid.height - 1) / factor + 1,
                                   grid.resolution * factor, grid.origin);
  for (int row = 0; row < grid.height; ++row) {
    throw_if_cancelled();
    for (int column = 0; column < grid.width; ++column) {
      Cell& target = coarse.at(column / factor, row / factor);
      target = std::max(target, grid.at(column, row));  // unknown < free < occupied
    }
  }
  return coarse;
}

OccupancyGrid transform_grid(const OccupancyGrid& grid, const SE2& T_target_map, double resolution) {
  validate(grid);
  if (!is_finite(T_target_map)) throw std::invalid_argument("the transform must be finite");
  if (!is_resolution(resolution))
    throw std::invalid_argument("the resolution must be between 1e-6 and 1000 metres per cell");
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
  if (!(columns * rows <= kMaxGridCells))
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
