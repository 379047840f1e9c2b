// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "grid/cell_box.hpp"
#include "gridmerge/grid/occupancy_grid.hpp"

namespace gridmerge::internal {

/// A grid drawn on another grid's lattice: cell (column, row) of `box` is
/// cells[(row - box.bottom) * stride + column - box.left], unknown where the grid has no cell.
struct CellsOnLattice {
  /// The columns of one row at which the grid has cells: the others are unknown.
  struct Span {
    int left = 0;
    int right = 0;
  };

  CellBox box;  ///< in cells of the lattice
  std::size_t stride = 0;
  std::vector<std::uint8_t> cells;  ///< values of Cell
  std::vector<Span> spans;          ///< one per row, within the box

  const std::uint8_t* row(int lattice_row) const {
    return cells.data() + static_cast<std::size_t>(lattice_row - box.bottom) * stride;
  }
  const std::uint8_t* at(int lattice_column, int lattice_row) const {
    return row(lattice_row) + (lattice_column - box.left);
  }
  const Span& span(int lattice_row) const {
    return spans[static_cast<std::size_t>(lattice_row - box.bottom)];
  }
};

/// Whether the grid has at most a million cells per side, and its corners lie within a million lattice cells
/// of the lattice's own: beyond that numbers would leave their range. O(1).
bool is_within_lattice(const OccupancyGrid& grid, const SE2& T_lattice_grid, double lattice_resolution);

/// The box of lattice cells whose centres may fall into `grid`, and perhaps a rim of others.
/// `T_lattice_grid` is between the lower-left corners, in metres; the lattice's cells have sides of
/// `lattice_resolution` metres. Throws std::invalid_argument unless is_within_lattice(). O(1).
CellBox box_on_lattice(const OccupancyGrid& grid, const SE2& T_lattice_grid, double lattice_resolution);

/// Gives every cell of `box` on the lattice the value of the cell of `grid` under its centre. `stride` of the
/// result is a multiple of `stride_multiple`. Fixed-point arithmetic with 40 fractional bits of a cell, so
/// the box must lie within the grid's own (box_on_lattice), and not be empty. Reuses the result's memory.
/// O(cells of the box).
void draw_nearest_cells(const OccupancyGrid& grid, const SE2& T_lattice_grid, double lattice_resolution,
                        const CellBox& box, std::size_t stride_multiple, CellsOnLattice& result);

}  // namespace gridmerge::internal
