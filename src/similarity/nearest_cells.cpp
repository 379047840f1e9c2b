// SPDX-License-Identifier: Apache-2.0
#include "similarity/nearest_cells.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <stdexcept>

#include "grid/box.hpp"
#include "grid/multiversion.hpp"
#include "gridmerge/grid/execution.hpp"

namespace gridmerge::internal {

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

/// Points in a grid, as fixed-point numbers of cells: `x + i * step_x`, `y + i * step_y`.
struct Line {
  std::int64_t x, y, step_x, step_y;

  Line from(std::int64_t i) const { return {x + i * step_x, y + i * step_y, step_x, step_y}; }
};

/// Columns that are drawn at a time: a turned row crosses the grid's rows, and a short piece of it comes by
/// the same cache lines as the piece of the row before.
constexpr int kPiece = 128;

/// The cells under the first `count` points of a line, all of them in the grid: nothing to check.
GRIDMERGE_MULTIVERSION
void draw_piece(const Line& line, const std::uint8_t* cells, std::uint32_t width, int count,
                std::uint8_t* out) {
  using Four = std::uint64_t __attribute__((vector_size(32)));
  using Halves = std::uint32_t __attribute__((vector_size(32)));
  const auto x = static_cast<std::uint64_t>(line.x), step_x = static_cast<std::uint64_t>(line.step_x);
  const auto y = static_cast<std::uint64_t>(line.y), step_y = static_cast<std::uint64_t>(line.step_y);
  constexpr Four kOrder{0, 1, 2, 3};
  Four xs = x + kOrder * step_x;
  Four ys = y + kOrder * step_y;
  std::uint64_t index[kPiece];
  for (int i = 0; i < count; i += 4) {
    const Four columns = xs >> kFractionalBits;
    const auto rows = reinterpret_cast<Halves>(ys >> kFractionalBits);  // the upper halves are 0
    const Four at = reinterpret_cast<Four>(rows * width) + columns;
    std::memcpy(index + i, &at, sizeof at);
    xs += 4 * step_x;
    ys += 4 * step_y;
  }
#pragma GCC unroll 8
  for (int i = 0; i < count; ++i) out[i] = cells[index[i]];
}

}  // namespace

namespace {

/// In cells of the lattice.
std::array<Point2, 4> corners_on_lattice(const OccupancyGrid& grid, const SE2& T_lattice_grid,
                                         double lattice_resolution) {
  const double width = grid.width * grid.resolution;
  const double height = grid.height * grid.resolution;
  std::array<Point2, 4> corners{{{0.0, 0.0}, {width, 0.0}, {0.0, height}, {width, height}}};
  for (Point2& corner : corners) {
    const Point2 at = T_lattice_grid * corner;
    corner = {at.x / lattice_resolution, at.y / lattice_resolution};
  }
  return corners;
}

}  // namespace

bool is_within_lattice(const OccupancyGrid& grid, const SE2& T_lattice_grid, double lattice_resolution) {
  const auto corners = corners_on_lattice(grid, T_lattice_grid, lattice_resolution);
  return grid.width <= kFarthest && grid.height <= kFarthest &&
         std::all_of(corners.begin(), corners.end(), [](const Point2& corner) {
           return std::abs(corner.x) < kFarthest && std::abs(corner.y) < kFarthest;
         });
}

CellBox box_on_lattice(const OccupancyGrid& grid, const SE2& T_lattice_grid, double lattice_resolution) {
  if (!is_within_lattice(grid, T_lattice_grid, lattice_resolution))
    throw std::invalid_argument("the maps are more than a million cells large or apart");
  Box box;
  for (const Point2& corner : corners_on_lattice(grid, T_lattice_grid, lattice_resolution)) box.add(corner);
  return {static_cast<int>(std::floor(box.min_x)), static_cast<int>(std::floor(box.min_y)),
          static_cast<int>(std::floor(box.max_x)) + 1, static_cast<int>(std::floor(box.max_y)) + 1};
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
  const auto columns = static_cast<std::int64_t>(box.width());
  const std::int64_t end_x = std::int64_t{grid.width} << kFractionalBits;
  const std::int64_t end_y = std::int64_t{grid.height} << kFractionalBits;
  const std::int64_t step_x = to_fixed_point(c);
  const std::int64_t step_y = to_fixed_point(s);
  const double first_x = box.left + 0.5;
  const double first_y = box.bottom + 0.5;
  const std::int64_t start_x = to_fixed_point(c * first_x - s * first_y + x0);
  const std::int64_t start_y = to_fixed_point(s * first_x + c * first_y + y0);
  const auto line_of = [&](std::int64_t row) {
    return Line{start_x - (row - box.bottom) * step_y, start_y + (row - box.bottom) * step_x, step_x, step_y};
  };
  result.spans.clear();
  for (int row = box.bottom; row < box.top; ++row) {
    const Line line = line_of(row);
    const Interval in_x = solve(line.x, line.step_x, end_x, columns);
    const Interval in_y = solve(line.y, line.step_y, end_y, columns);
    const std::int64_t first = std::clamp(std::max(in_x.first, in_y.first), std::int64_t{0}, columns);
    const std::int64_t last = std::clamp(std::min(in_x.last, in_y.last), first, columns);
    result.spans.push_back({box.left + static_cast<int>(first), box.left + static_cast<int>(last)});
  }

  const auto* cells = reinterpret_cast<const std::uint8_t*>(grid.cells.data());
  for (int piece = box.left; piece < box.right; piece += kPiece) {
    throw_if_cancelled();
    for (int row = box.bottom; row < box.top; ++row) {
      const int first = std::max(result.span(row).left, piece);
      const int last = std::min(result.span(row).right, piece + kPiece);
      if (first >= last) continue;
      std::uint8_t* out = result.cells.data() + static_cast<std::size_t>(row - box.bottom) * result.stride;
      draw_piece(line_of(row).from(first - box.left), cells, static_cast<std::uint32_t>(grid.width),
                 last - first, out + (first - box.left));
    }
  }
}

}  // namespace gridmerge::internal
