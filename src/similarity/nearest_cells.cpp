// SPDX-License-Identifier: Apache-2.0
#include "nearest_cells.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

namespace gridmerge {

namespace {

constexpr int kFractionalBits = 40;
constexpr double kOne = static_cast<double>(std::int64_t{1} << kFractionalBits);
constexpr double kFarthest = 1e6;  // cells: 20 bits, so that sums of products stay below 63

std::int64_t to_fixed_point(double cells) {
  return std::llround(cells * kOne);
}

std::int64_t floor_divide(std::int64_t a, std::int64_t positive) {
  return a >= 0 ? a / positive : -((-a + positive - 1) / positive);
}

/// The integers k in [first, last).
struct Interval {
  std::int64_t first;
  std::int64_t last;
};

/// Where 0 <= start + k * step < end.
Interval solve(std::int64_t start, std::int64_t step, std::int64_t end, std::int64_t count) {
  if (step == 0) return {0, start >= 0 && start < end ? count : 0};
  if (step > 0) return {-floor_divide(start, step), -floor_divide(start - end, step)};
  return {floor_divide(start - end, -step) + 1, floor_divide(start, -step) + 1};
}

}  // namespace

CellBox box_on_lattice(const OccupancyGrid& grid, const SE2& T_lattice_grid, double lattice_resolution) {
  const double width = grid.width * grid.resolution;
  const double height = grid.height * grid.resolution;
  double left = kFarthest, right = -kFarthest, bottom = kFarthest, top = -kFarthest;
  for (const Point2& corner :
       std::array<Point2, 4>{{{0.0, 0.0}, {width, 0.0}, {0.0, height}, {width, height}}}) {
    const Point2 at = T_lattice_grid * corner;
    const double x = at.x / lattice_resolution;
    const double y = at.y / lattice_resolution;
    if (!(std::abs(x) < kFarthest && std::abs(y) < kFarthest))
      throw std::invalid_argument("the transform puts the maps more than a million cells apart");
    left = std::min(left, x);
    right = std::max(right, x);
    bottom = std::min(bottom, y);
    top = std::max(top, y);
  }
  return {static_cast<int>(std::floor(left)), static_cast<int>(std::floor(bottom)),
          static_cast<int>(std::floor(right)) + 1, static_cast<int>(std::floor(top)) + 1};
}

CellBox intersect(const CellBox& a, const CellBox& b) {
  CellBox common{std::max(a.left, b.left), std::max(a.bottom, b.bottom), std::min(a.right, b.right),
                 std::min(a.top, b.top)};
  common.right = std::max(common.left, common.right);
  common.top = std::max(common.bottom, common.top);
  return common;
}

void draw_nearest_cells(const OccupancyGrid& grid, const SE2& T_lattice_grid, double lattice_resolution,
                        const CellBox& box, std::size_t stride_multiple, CellsOnLattice& result) {
  result.box = box;
  result.stride =
      (static_cast<std::size_t>(box.width()) + stride_multiple - 1) / stride_multiple * stride_multiple;
  result.cells.assign(result.stride * static_cast<std::size_t>(box.height()), 0);

  const SE2 T_grid_lattice = inverse(T_lattice_grid);
  const double scale = lattice_resolution / grid.resolution;
  const double c = std::cos(T_grid_lattice.theta) * scale;
  const double s = std::sin(T_grid_lattice.theta) * scale;
  const double x0 = T_grid_lattice.x / grid.resolution;
  const double y0 = T_grid_lattice.y / grid.resolution;
  const std::int64_t step_x = to_fixed_point(c);
  const std::int64_t step_y = to_fixed_point(s);
  const std::int64_t end_x = std::int64_t{grid.width} << kFractionalBits;
  const std::int64_t end_y = std::int64_t{grid.height} << kFractionalBits;
  const auto* cells = reinterpret_cast<const std::uint8_t*>(grid.cells.data());

  // In blocks of columns: a turned row crosses the grid's rows, and a short piece of it comes by the same
  // cache lines as the piece of the row before.
  constexpr std::int64_t kBlock = 128;
  for (std::int64_t block = 0; block < box.width(); block += kBlock) {
    for (int row = box.bottom; row < box.top; ++row) {
      const double lattice_x = box.left + 0.5;
      const double lattice_y = row + 0.5;
      std::int64_t x = to_fixed_point(c * lattice_x - s * lattice_y + x0);
      std::int64_t y = to_fixed_point(s * lattice_x + c * lattice_y + y0);
      const Interval in_x = solve(x, step_x, end_x, box.width());
      const Interval in_y = solve(y, step_y, end_y, box.width());
      const std::int64_t first = std::max({in_x.first, in_y.first, block});
      const std::int64_t last = std::min({in_x.last, in_y.last, block + kBlock, std::int64_t{box.width()}});
      if (first >= last) continue;
      x += first * step_x;
      y += first * step_y;
      std::uint8_t* out = result.cells.data() + static_cast<std::size_t>(row - box.bottom) * result.stride;
      for (std::int64_t column = first; column < last; ++column) {  // inside the grid: nothing to check
        out[column] = cells[(y >> kFractionalBits) * grid.width + (x >> kFractionalBits)];
        x += step_x;
        y += step_y;
      }
    }
  }
}

}  // namespace gridmerge
