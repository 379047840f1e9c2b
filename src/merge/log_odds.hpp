// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "grid/box.hpp"
#include "grid/cell_box.hpp"
#include "gridmerge/grid/deformation.hpp"
#include "gridmerge/grid/occupancy_grid.hpp"
#include "internal_export.hpp"

namespace gridmerge::internal {

/// Where the cells of an output grid lie: upright (yaw 0) in the output frame.
struct Lattice {
  int width = 0;            ///< columns
  int height = 0;           ///< rows
  double resolution = 1.0;  ///< metres per cell side
  Point2 corner;            ///< lower-left corner of cell (0, 0) in the output frame [m]

  CellBox whole() const { return {0, 0, width, height}; }
  friend bool operator==(const Lattice&, const Lattice&) = default;
};

/// What the known cells of all inputs cover in the output frame [m]. Throws std::invalid_argument for an
/// invalid grid or a transform that is not finite. `deformations` as of fuse(). O(cells of the inputs).
GRIDMERGE_INTERNAL_EXPORT Box covered_box(const std::vector<PlacedMap>& inputs,
                                          const std::vector<Deformation>& deformations);

/// Whether a deformation moves anything. O(deformations).
bool is_any_bent(const std::vector<Deformation>& deformations);

/// How large a lattice may be: powers of two.
struct LatticeLimits {
  double cells = kMaxGridCells;
  double side = kMaxGridCells;  ///< cells of a side
};

/// The lattice of `resolution` [m] that just covers the known cells of all inputs; one cell when there is
/// none. It continues the cell boundaries of the input that lies at the identity, so that the map that gives
/// the frame is not shifted by a part of a cell; without such an input it starts at the lower-left corner of
/// what it covers. The inputs' order plays no part. Throws std::invalid_argument for an invalid grid, a
/// transform that is not finite, a resolution that is not positive, or a lattice beyond the limits.
/// `deformations` as of fuse(). O(cells of the inputs).
GRIDMERGE_INTERNAL_EXPORT Lattice cover(const std::vector<PlacedMap>& inputs, double resolution,
                                        const std::vector<Deformation>& deformations = {},
                                        const LatticeLimits& limits = {});

/// Log-odds are kept in steps of 1/1024 nat, so that sums are exact and their order does not matter.
inline constexpr double kLogOddsPerNat = 1024.0;

/// What one input says of the lattice cells in a box: the log-odds of `occupied`, positive for an occupied
/// cell, negative for a free one, 0 for unknown.
struct LogOddsPatch {
  int column = 0;  ///< of the box's lower-left cell on the lattice
  int row = 0;
  int width = 0;  ///< of the box
  int height = 0;
  std::vector<std::int16_t> log_odds;  ///< row-major, width * height values, in 1 / kLogOddsPerNat nat

  std::size_t index(int patch_column, int patch_row) const {
    return static_cast<std::size_t>(patch_row) * static_cast<std::size_t>(width) +
           static_cast<std::size_t>(patch_column);
  }
  std::int16_t at(int patch_column, int patch_row) const { return log_odds[index(patch_column, patch_row)]; }
};

/// Draws one input on the lattice. The rules:
/// - A map says "occupied" with probability 0.85 and "free" with 0.35: a wall that one map saw outlives two
///   maps that did not. Where the map has probabilities they set the strength instead, at most 0.88 and at
///   least 0.12, so that no single map is beyond contradiction. A cell that it calls unknown says nothing.
/// - A lattice cell takes the map's cell under its centre. Two occupied cells that touch only at a corner
///   count as joined by a band one cell wide. A wall one cell thick so stays in one piece at any angle; a
///   lone occupied cell may become none or two.
/// - Of a map finer than the lattice, each lattice cell takes the strongest "occupied" among the map's
///   cells in it, else the weakest "free": one statement a map, however many cells it has there, and thin
///   walls stay.
/// - A map coarser than the lattice says of every lattice cell what it says of its own cell there.
/// - A lattice cell looks up a bent map where the deformation's inverse says, which is exact at every few
///   cells and linear between them: off by a thousandth of the spacing of the deformation's lattice at most.
///
/// O(map cells + lattice cells in the bounding box of the map's known cells). Throws std::invalid_argument
/// for an invalid grid or a transform that is not finite.
GRIDMERGE_INTERNAL_EXPORT LogOddsPatch draw_log_odds(const PlacedMap& input, const Lattice& lattice,
                                                     const Deformation& deformation = {});

/// The same of the lattice cells in a box alone: the values are those of the whole lattice. O(map cells +
/// lattice cells in the box).
LogOddsPatch draw_log_odds(const PlacedMap& input, const Lattice& lattice, const Deformation& deformation,
                           const CellBox& within);

}  // namespace gridmerge::internal
