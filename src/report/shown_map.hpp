// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>

#include "gridmerge/grid/occupancy_grid.hpp"
#include "report/json_values.hpp"

namespace gridmerge::internal {

/// Browsers draw no larger maps at once.
inline constexpr std::size_t kMaxShownCells = std::size_t{1} << 25;

/// The grid, or where it has more than `max_cells` cells, the grid with cells of twice the side, as often as
/// it takes: occupied where any of the four cells is, else free where any is. `max_cells` is at least 1. The
/// grid has a cell at least. O(cells).
OccupancyGrid at_most(OccupancyGrid grid, std::size_t max_cells);

/// A map as the report page takes it: cropped to what is known.
struct ShownMap {
  int width = 0;  ///< columns; 0 when nothing is known
  int height = 0;
  double resolution = 1.0;  ///< metres per cell side
  SE2 origin;               ///< takes a point measured from the lower-left corner to the map frame
  /// Base64 of a zlib stream (RFC 1950) of width * height bytes, row 0 at the bottom: 0 unknown, 1 free,
  /// 2 occupied. "" when nothing is known.
  std::string cells;
  /// As many times as wide as those of the grid is each cell: the page says so.
  int coarser = 1;
};

/// Of a grid of any size, 0 x 0 too; large ones are shown coarser (at_most(), kMaxShownCells). O(cells).
ShownMap show_map(const OccupancyGrid& grid, std::size_t max_cells = kMaxShownCells);

/// As the page's script reads it.
Json grid_json(const ShownMap& map);

}  // namespace gridmerge::internal
