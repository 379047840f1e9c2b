// SPDX-License-Identifier: Apache-2.0
#include "match/prepared_map.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>
#include <utility>

#include "grid/longer_side.hpp"
#include "grid/painted.hpp"
#include "grid/quarter_turned.hpp"
#include "gridmerge/grid/resample.hpp"
#include "gridmerge/match/match.hpp"
#include "match/drawn_walls.hpp"
#include "match/scaled_pose.hpp"

namespace gridmerge {

using namespace internal;

namespace {

/// Larger maps are compared in larger cells, but no larger than rooms and doors allow...
constexpr double kCellsAlongSide = 800.0;
constexpr double kCoarsestCell = 0.1;  // [m], unless the maps themselves are coarser
/// ...up to where time and memory have to be bounded.
constexpr double kMaxCellsAlongSide = 4000.0;

/// How many occupied cells lie in the quarters of a grid, counter-clockwise from the lower left; those on a
/// middle row or column are in none.
std::array<std::size_t, 4> occupied_by_quarter(const OccupancyGrid& grid) {
  std::array<std::size_t, 4> counts{};
  for (int row = 0; row < grid.height; ++row) {
    if (2 * row + 1 == grid.height) continue;
    const bool above = 2 * row >= grid.height;
    const Cell* line = grid.cells.data() + grid.index(0, row);
    const auto count = [&](int from, int to) {
      std::size_t occupied = 0;
      for (int column = from; column < to; ++column) occupied += line[column] == Cell::occupied ? 1 : 0;
      return occupied;
    };
    counts[above ? 3 : 0] += count(0, grid.width / 2);
    counts[above ? 2 : 1] += count((grid.width + 1) / 2, grid.width);
  }
  return counts;
}

/// The map in the one of its four orientations that comes first in an order of their own, so that the answer
/// does not depend on the one in which it was drawn.
OccupancyGrid in_canonical_orientation(OccupancyGrid grid) {
  const std::array<std::size_t, 4> counts = occupied_by_quarter(grid);
  const auto key = [&](int quarters) {
    // A turn by a quarter takes the first quarter to the second.
    std::array<std::size_t, 5> order{static_cast<std::size_t>(quarters % 2 == 0 ? grid.width : grid.height)};
    for (int i = 0; i < 4; ++i) order[1 + i] = counts[(i - quarters + 4) % 4];
    return order;
  };
  int best = 0;
  for (int quarters = 1; quarters < 4; ++quarters) {
    if (key(quarters) < key(best) || (key(quarters) == key(best) && quarter_turned(grid, quarters).cells <
                                                                        quarter_turned(grid, best).cells))
      best = quarters;
  }
  return best == 0 ? std::move(grid) : quarter_turned(grid, best);
}

}  // namespace

PreparedMap::PreparedMap(const OccupancyGrid& grid) : drawn_(std::make_unique<DrawnWalls>()) {
  validate(grid);
  known_ = in_canonical_orientation(crop_to_known(without_painted(crop_to_known(grid))));
  counts_ = count_cells(known_);
}

PreparedMap::PreparedMap(OccupancyGrid known, const CellCounts& counts)
    : known_(std::move(known)), counts_(counts), drawn_(std::make_unique<DrawnWalls>()) {}

PreparedMap::~PreparedMap() = default;

PreparedMap DrawnWalls::scaled(const PreparedMap& map, double factor) {
  return {internal::scaled(map.known_, factor), map.counts_};
}

const LikelihoodField& DrawnWalls::of(const PreparedMap& map, double cell) {
  DrawnWalls& drawn = *map.drawn_;
  const std::lock_guard lock(drawn.drawing_);
  std::unique_ptr<const LikelihoodField>& walls = drawn.by_cell_[cell];
  if (!walls) walls = std::make_unique<const LikelihoodField>(make_likelihood_field(map.known_, cell));
  return *walls;
}

namespace internal {

bool is_smaller(const PreparedMap& a, const PreparedMap& b) {
  const auto key = [](const PreparedMap& map) {
    const OccupancyGrid& grid = map.known();
    return std::tuple(static_cast<double>(map.counts().known()) * grid.resolution * grid.resolution,
                      map.counts().occupied, grid.width, grid.height);
  };
  const auto key_a = key(a);
  const auto key_b = key(b);
  return key_a != key_b ? key_a < key_b : a.known().cells < b.known().cells;
}

bool are_swapped(const PreparedMap& fixed, const PreparedMap& moving) {
  if (is_smaller(fixed, moving)) return true;
  if (is_smaller(moving, fixed)) return false;
  const auto key = [](const SE2& origin) { return std::tuple(origin.x, origin.y, origin.theta); };
  return key(fixed.known().origin) < key(moving.known().origin);
}

double working_cell(const PreparedMap& fixed, const PreparedMap& moving) {
  const double resolution = std::max(fixed.known().resolution, moving.known().resolution);
  const double side = std::max(longer_side(fixed.known()), longer_side(moving.known())) / resolution;
  const double wanted = std::ceil(side / kCellsAlongSide);
  const double least = std::ceil(side / kMaxCellsAlongSide);
  const double most = std::floor(kCoarsestCell / resolution + 1e-9);
  return resolution * std::max({1.0, least, std::min(wanted, most)});
}

}  // namespace internal

}  // namespace gridmerge
