// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "gridmerge/grid/occupancy_grid.hpp"

namespace gridmerge {

/// An input of a fusion: the map, and the transform that takes its frame to the output's.
struct PlacedMap {
  const OccupancyGrid* map = nullptr;  ///< not owned; outlives the call
  SE2 T_output_map;
};

struct FusedMap {
  OccupancyGrid grid;          ///< upright (yaw 0), in the output frame; ternary cells and probabilities
  std::size_t agreeing = 0;    ///< cells known in two or more inputs, all equal
  std::size_t conflicting = 0; ///< cells that some input calls free and another occupied
};

/// Fuses all inputs in one pass: the log-odds of every input that knows a cell are summed and clamped. The sums are
/// integers, so the result does not depend on the inputs' order. `resolution` in metres.
/// Throws std::invalid_argument when there is no input or the output would exceed 2^28 cells.
FusedMap fuse(const std::vector<PlacedMap>& inputs, double resolution);

}  // namespace gridmerge
