// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "gridmerge/export.hpp"
#include "gridmerge/grid/deformation.hpp"
#include "gridmerge/grid/occupancy_grid.hpp"

namespace gridmerge {

/// omega of a fused map's inputs (Birk & Carpin 2006, eq. 3).
struct EqualCells {
  std::int64_t equal = 0;  ///< cells of the map at which all inputs have the same value, unknown included
  std::int64_t cells = 0;  ///< of the map

  /// Of all cells, in [0, 1]; 0 when there are none.
  double share() const { return cells == 0 ? 0.0 : static_cast<double>(equal) / static_cast<double>(cells); }
};

/// One map of several, and how these agree.
struct FusedMap {
  OccupancyGrid grid;           ///< upright (yaw 0), in the output frame; ternary cells and probabilities
  std::size_t agreeing = 0;     ///< cells known in two or more inputs, all equal
  std::size_t conflicting = 0;  ///< cells that some input calls free and another occupied
  /// None where the inputs cannot be compared so (see count_equal_cells()), or one is bent.
  std::optional<EqualCells> omega = {};
};

/// Fuses all maps, the inputs, in one pass. The result covers their known cells, upright in the output frame,
/// in cells of `resolution` metres; it continues the cell boundaries of the input that lies at the identity,
/// if one does. The log-odds of every input that knows a cell are summed and clamped to 3.5 nats (a
/// probability of 0.03 to 0.97). A positive sum is occupied, a negative one free, and log-odds that cancel
/// out are unknown. A map says "occupied" with probability 0.85 and "free" with 0.35, or with its own
/// probabilities, at most 0.88 and at least 0.12; a wall one cell thick stays in one piece at any angle.
/// Where most of what an input knows was painted black (see PreparedMap), what was painted counts as unknown:
/// it would hide what others have seen. The sums are integers, so
/// the result does not depend on the inputs' order. Throws std::invalid_argument for no input, an invalid
/// grid, a transform that is not finite, a resolution that is no map's (see is_resolution()), and a result of
/// more than kMaxGridCells. O(cells of the inputs + cells of the result).
///
/// `deformations[i]`, where there is one, bends input i before its transform places it; it may be shorter
/// than `maps`. Each cell of the result looks up the bent input where it comes from, to a tenth of a cell,
/// so this is one pass too. Where a map is squeezed, a wall one cell thick may get gaps. With a bent input
/// there is no omega.
GRIDMERGE_EXPORT FusedMap fuse(const std::vector<PlacedMap>& maps, double resolution,
                               const std::vector<Deformation>& deformations = {});

/// A map as its deformation bends it, in cells of its own size along its own rows: for drawing and for
/// whoever takes rigid maps only. The map itself if the deformation is the identity; otherwise without
/// probabilities. Throws std::invalid_argument for an invalid grid, and a result of more than kMaxGridCells.
/// O(cells).
GRIDMERGE_EXPORT OccupancyGrid bent_map(const OccupancyGrid& map, const Deformation& deformation);

}  // namespace gridmerge
