// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <stdexcept>
#include <string>

#include "gridmerge/grid/execution.hpp"
#include "gridmerge/similarity/image_similarity.hpp"
#include "similarity/distance_kernels.hpp"

namespace gridmerge {

using namespace internal;

namespace {

/// kNoDistance everywhere.
DistanceMap make_empty(const OccupancyGrid& grid) {
  validate(grid);
  if (grid.width > kMaxDistanceMapSides - grid.height) {
    throw std::invalid_argument(
        "the map is too large for a distance map: its width and height add up to more than " +
        std::to_string(kMaxDistanceMapSides) + " cells");
  }
  return {grid.width, grid.height, std::vector<std::uint16_t>(grid.cells.size(), kNoDistance)};
}

/// Relaxes every cell from its neighbours one column and one row away, in the order in which these come
/// first: -1 is from the upper left corner on, 1 from the lower right one.
void pass_from_corner(DistanceMap& map, int away) {
  const auto index = [&](int column, int row) {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(map.width) +
           static_cast<std::size_t>(column);
  };
  for (int i = 0; i < map.height; ++i) {
    throw_if_cancelled();
    const int row = away < 0 ? map.height - 1 - i : i;
    for (int j = 0; j < map.width; ++j) {
      const int column = away < 0 ? j : map.width - 1 - j;
      std::uint16_t& here = map.distances[index(column, row)];
      const auto relax = [&](std::uint16_t there) {
        if (there != kNoDistance) here = std::min(here, static_cast<std::uint16_t>(there + 1));
      };
      if (j > 0) relax(map.distances[index(column + away, row)]);
      if (i > 0) relax(map.distances[index(column, row - away)]);
    }
  }
}

}  // namespace

DistanceMapPasses trace_distance_map(const OccupancyGrid& grid, Cell value) {
  DistanceMapPasses passes;
  passes.start = make_empty(grid);
  std::transform(grid.cells.begin(), grid.cells.end(), passes.start.distances.begin(),
                 [&](Cell cell) { return cell == value ? std::uint16_t{0} : kNoDistance; });
  passes.forward = passes.start;
  pass_from_corner(passes.forward, -1);
  passes.backward = passes.forward;
  pass_from_corner(passes.backward, 1);
  return passes;
}

DistanceMap make_distance_map(const OccupancyGrid& grid, Cell value) {
  DistanceMap map = make_empty(grid);
  if (std::find(grid.cells.begin(), grid.cells.end(), value) == grid.cells.end()) return map;

  // With whole tiles and strips; what is too much never holds the value.
  const std::size_t stride = (static_cast<std::size_t>(grid.width) + kTile - 1) / kTile * kTile;
  const int strips = (grid.height + kStripRows - 1) / kStripRows;
  std::vector<std::uint16_t> rows(stride * kStripRows * static_cast<std::size_t>(strips), kFarDistance);
  const auto* cells = reinterpret_cast<const std::uint8_t*>(grid.cells.data());
  const auto row_at = [&](int row) { return rows.data() + static_cast<std::size_t>(row) * stride; };
  const std::vector<std::uint16_t> below(stride, kFarDistance);  // the first row
  for (int row = 0; row < grid.height; ++row) {
    throw_if_cancelled();
    pass_row(cells + grid.index(0, row), static_cast<std::size_t>(grid.width),
             static_cast<std::uint8_t>(value), row > 0 ? row_at(row - 1) : below.data(), row_at(row));
  }
  for (int row = grid.height - 2; row >= 0; --row) relax_row(row_at(row), row_at(row + 1), stride);

  std::vector<std::uint16_t> strip(stride * kStripRows);
  for (int first = 0; first < grid.height; first += kStripRows) {
    throw_if_cancelled();
    rows_to_strip(row_at(first), stride, static_cast<int>(stride), strip.data());
    sweep_right(strip.data(), static_cast<int>(stride));
    sweep_left(strip.data(), static_cast<int>(stride));
    strip_to_rows(strip.data(), static_cast<int>(stride), row_at(first), stride);
  }
  for (int row = 0; row < grid.height; ++row)
    std::copy_n(row_at(row), grid.width,
                map.distances.begin() + static_cast<std::ptrdiff_t>(grid.index(0, row)));
  return map;
}

}  // namespace gridmerge
