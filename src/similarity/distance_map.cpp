// SPDX-License-Identifier: Apache-2.0
#include "gridmerge/similarity/distance_map.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>

#include "distance_kernels.hpp"

namespace gridmerge {

DistanceMap make_distance_map(const OccupancyGrid& grid, Cell value) {
  validate(grid);
  if (grid.width > kMaxDistanceMapSides - grid.height) {
    throw std::invalid_argument(
        "the map is too large for a distance map: its width and height add up to more than " +
        std::to_string(kMaxDistanceMapSides) + " cells");
  }
  DistanceMap map{grid.width, grid.height, std::vector<std::uint16_t>(grid.cells.size(), kNoDistance)};
  if (std::find(grid.cells.begin(), grid.cells.end(), value) == grid.cells.end()) return map;

  // With whole tiles and strips; what is too much never holds the value.
  const std::size_t stride = (static_cast<std::size_t>(grid.width) + kTile - 1) / kTile * kTile;
  const int strips = (grid.height + kStripRows - 1) / kStripRows;
  std::vector<std::uint16_t> rows(stride * kStripRows * static_cast<std::size_t>(strips), kFarDistance);
  const auto* cells = reinterpret_cast<const std::uint8_t*>(grid.cells.data());
  const auto row_at = [&](int row) { return rows.data() + static_cast<std::size_t>(row) * stride; };
  const std::vector<std::uint16_t> below(stride, kFarDistance);  // the first row
  for (int row = 0; row < grid.height; ++row) {
    pass_row(cells + grid.index(0, row), static_cast<std::size_t>(grid.width),
             static_cast<std::uint8_t>(value), row > 0 ? row_at(row - 1) : below.data(), row_at(row));
  }
  for (int row = grid.height - 2; row >= 0; --row) relax_row(row_at(row), row_at(row + 1), stride);

  std::vector<std::uint16_t> strip(stride * kStripRows);
  for (int first = 0; first < grid.height; first += kStripRows) {
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
