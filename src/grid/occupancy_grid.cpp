// SPDX-License-Identifier: Apache-2.0
#include "gridmerge/grid/occupancy_grid.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <stdexcept>

#include "grid/multiversion.hpp"

namespace gridmerge {

OccupancyGrid make_grid(int width, int height, double resolution, const SE2& origin, Cell fill) {
  if (width < 0 || height < 0) throw std::invalid_argument("a map's width and height must not be negative");
  OccupancyGrid grid;
  grid.width = width;
  grid.height = height;
  grid.resolution = resolution;
  grid.origin = origin;
  grid.cells.assign(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), fill);
  return grid;
}

namespace {

/// Adds how many of the cells are free and how many are occupied; at most 255, so that counters of one byte
/// will do, of which a register holds many.
GRIDMERGE_MULTIVERSION
void add_few(const Cell* cells, std::size_t count, CellCounts& counts) {
  std::uint8_t free = 0, occupied = 0;
  for (std::size_t i = 0; i < count; ++i) {
    free = static_cast<std::uint8_t>(free + (cells[i] == Cell::free));
    occupied = static_cast<std::uint8_t>(occupied + (cells[i] == Cell::occupied));
  }
  counts.free += free;
  counts.occupied += occupied;
}

GRIDMERGE_MULTIVERSION
std::uint8_t highest(const std::vector<Cell>& cells) {
  std::uint8_t highest = 0;
  for (const Cell cell : cells) highest = std::max(highest, static_cast<std::uint8_t>(cell));
  return highest;
}

}  // namespace

CellCounts count_cells(const OccupancyGrid& grid) {
  constexpr std::size_t kFew = 7 * std::size_t{32};  // whole registers
  CellCounts counts;
  for (std::size_t i = 0; i < grid.cells.size(); i += kFew)
    add_few(grid.cells.data() + i, std::min(kFew, grid.cells.size() - i), counts);
  counts.unknown = grid.cells.size() - counts.free - counts.occupied;
  return counts;
}

void validate(const OccupancyGrid& grid) {
  if (grid.width <= 0 || grid.height <= 0)
    throw std::invalid_argument("the map's width and height must be positive");
  const std::size_t size = static_cast<std::size_t>(grid.width) * static_cast<std::size_t>(grid.height);
  if (grid.cells.size() != size)
    throw std::invalid_argument("the map's cells do not number width times height");
  if (!grid.probability.empty() && grid.probability.size() != size) {
    throw std::invalid_argument("the map's probabilities do not number width times height");
  }
  if (!is_resolution(grid.resolution))
    throw std::invalid_argument("the map's resolution must be between 1e-6 and 1000 metres per cell");
  if (!is_finite(grid.origin)) throw std::invalid_argument("the map's origin must be finite");
  if (std::max(std::abs(grid.origin.x), std::abs(grid.origin.y)) > 2.0 * kMaxOrigin)
    throw std::invalid_argument("the map's origin must lie within 2e9 metres of zero");
  if (highest(grid.cells) > static_cast<std::uint8_t>(Cell::occupied))
    throw std::invalid_argument("the map's cells must be unknown, free or occupied");
}

void validate(const PlacedMap& placed) {
  if (placed.map == nullptr) throw std::invalid_argument("a placed map must have a map");
  validate(*placed.map);
  if (!is_finite(placed.T_output_map))
    throw std::invalid_argument("the transform of a placed map must be finite");
}

}  // namespace gridmerge
