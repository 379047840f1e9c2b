// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "gridmerge/grid/occupancy_grid.hpp"

/// The paper's measures as it writes them down, with nothing done to be fast: what the real ones are held
/// against, in tests for their values and in benchmarks for their speed.
namespace gridmerge::literal {

inline constexpr int kInfinite = std::numeric_limits<int>::max() / 2;

/// Algorithm 2: one pass from the lower left, one from the upper right.
inline std::vector<int> distance_map(const OccupancyGrid& map, Cell value) {
  std::vector<int> distance(map.cells.size());
  for (int row = 0; row < map.height; ++row) {
    for (int column = 0; column < map.width; ++column)
      distance[map.index(column, row)] = map.at(column, row) == value ? 0 : kInfinite;
  }
  for (int row = 0; row < map.height; ++row) {
    for (int column = 0; column < map.width; ++column) {
      int& here = distance[map.index(column, row)];
      if (column > 0) here = std::min(here, distance[map.index(column - 1, row)] + 1);
      if (row > 0) here = std::min(here, distance[map.index(column, row - 1)] + 1);
    }
  }
  for (int row = map.height - 1; row >= 0; --row) {
    for (int column = map.width - 1; column >= 0; --column) {
      int& here = distance[map.index(column, row)];
      if (column + 1 < map.width) here = std::min(here, distance[map.index(column + 1, row)] + 1);
      if (row + 1 < map.height) here = std::min(here, distance[map.index(column, row + 1)] + 1);
    }
  }
  return distance;
}

struct Directed {
  std::int64_t sum = 0;
  std::int64_t count = 0;
};

/// Algorithm 3. All zeros when one of the maps has no such cell.
inline Directed directed_distance(const OccupancyGrid& m1, const OccupancyGrid& m2, Cell value) {
  const std::vector<int> distance = distance_map(m2, value);
  Directed result;
  for (int row = 0; row < m1.height; ++row) {
    for (int column = 0; column < m1.width; ++column) {
      if (m1.at(column, row) != value) continue;
      const int there = distance[m1.index(column, row)];
      if (there >= kInfinite) return {};
      result.sum += there;
      ++result.count;
    }
  }
  return result;
}

/// Each cell of `lattice` (whose cells do not matter) with the value of the cell of `map` under its centre.
inline OccupancyGrid draw_on(const OccupancyGrid& lattice, const OccupancyGrid& map,
                             const SE2& T_lattice_map) {
  OccupancyGrid drawn =
      make_grid(lattice.width, lattice.height, lattice.resolution, lattice.origin, Cell::unknown);
  // Between the lower-left corners, with sine and cosine taken once.
  const SE2 T_grid_lattice = inverse(T_lattice_map * map.origin) * lattice.origin;
  const double c = std::cos(T_grid_lattice.theta);
  const double s = std::sin(T_grid_lattice.theta);
  for (int row = 0; row < drawn.height; ++row) {
    for (int column = 0; column < drawn.width; ++column) {
      const Point2 p{(column + 0.5) * lattice.resolution, (row + 0.5) * lattice.resolution};
      const double x = std::floor((T_grid_lattice.x + c * p.x - s * p.y) / map.resolution);
      const double y = std::floor((T_grid_lattice.y + s * p.x + c * p.y) / map.resolution);
      if (x < 0 || y < 0 || x >= map.width || y >= map.height) continue;
      drawn.at(column, row) = map.at(static_cast<int>(x), static_cast<int>(y));
    }
  }
  return drawn;
}

struct Similarity {
  Directed fixed_to_moving_free, moving_to_fixed_free, fixed_to_moving_occupied, moving_to_fixed_occupied;
  std::int64_t agreement = 0;
  std::int64_t disagreement = 0;
};

/// Of two maps on one lattice.
inline Similarity measure(const OccupancyGrid& m1, const OccupancyGrid& m2) {
  Similarity result;
  result.fixed_to_moving_free = directed_distance(m1, m2, Cell::free);
  result.moving_to_fixed_free = directed_distance(m2, m1, Cell::free);
  result.fixed_to_moving_occupied = directed_distance(m1, m2, Cell::occupied);
  result.moving_to_fixed_occupied = directed_distance(m2, m1, Cell::occupied);
  for (std::size_t i = 0; i < m1.cells.size(); ++i) {
    if (m1.cells[i] == Cell::unknown || m2.cells[i] == Cell::unknown) continue;
    ++(m1.cells[i] == m2.cells[i] ? result.agreement : result.disagreement);
  }
  return result;
}

}  // namespace gridmerge::literal
