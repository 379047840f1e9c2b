// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "gridmerge/export.hpp"
#include "gridmerge/grid/occupancy_grid.hpp"

namespace gridmerge {

/// In a DistanceMap: the grid has no cell of the value.
inline constexpr std::uint16_t kNoDistance = 0xffff;

/// Manhattan distances between cells are kept in 16 bits: width + height must not exceed this.
inline constexpr int kMaxDistanceMapSides = 32000;

/// d-map_c of Birk & Carpin 2006: for every cell of a grid the Manhattan distance [cells] to the nearest cell
/// of one value, row-major as the grid; kNoDistance everywhere if there is none.
struct DistanceMap {
  int width = 0;                         ///< columns
  int height = 0;                        ///< rows
  std::vector<std::uint16_t> distances;  ///< width * height values [cells]

  /// The distance at a cell, which has to be inside.
  std::uint16_t at(int column, int row) const {
    return distances[static_cast<std::size_t>(row) * static_cast<std::size_t>(width) +
                     static_cast<std::size_t>(column)];
  }
};

/// Algorithm 2 of the paper, with its two passes split by direction: both ways along the columns, then both
/// ways along the rows, sixteen of which go at a time. Throws std::invalid_argument if width + height >
/// kMaxDistanceMapSides. O(cells); vectorised.
GRIDMERGE_EXPORT DistanceMap make_distance_map(const OccupancyGrid& grid, Cell value);

/// Algorithm 2 of the paper to look at: what its two passes leave.
struct DistanceMapPasses {
  DistanceMap start;     ///< 0 at the cells of the value, kNoDistance elsewhere
  DistanceMap forward;   ///< after the pass from the upper left corner on: the left and the upper neighbour
  DistanceMap backward;  ///< after the pass from the lower right corner on: d-map_c
};

/// The passes as the paper writes them, cell by cell; `backward` equals make_distance_map(), which is ten
/// times as fast. The upper row is the last one: y points up. Throws as make_distance_map(). O(cells).
GRIDMERGE_EXPORT DistanceMapPasses trace_distance_map(const OccupancyGrid& grid, Cell value);

}  // namespace gridmerge
