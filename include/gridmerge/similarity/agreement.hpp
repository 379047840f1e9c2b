// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "gridmerge/grid/occupancy_grid.hpp"

namespace gridmerge {

/// Cells that two maps know in common (Birk & Carpin 2006, the lock term and the acceptance index).
struct Agreement {
  std::int64_t agreement = 0;     ///< cells of the moving map that are known in both and equal
  std::int64_t disagreement = 0;  ///< cells of the moving map that are known in both and different
  double overlap = 0.0;           ///< share of the smaller map's known area that is known in both, in [0, 1]

  /// agreement / (agreement + disagreement); 0 when nothing is known in common.
  double acceptance_index() const {
    const std::int64_t both = agreement + disagreement;
    return both == 0 ? 0.0 : static_cast<double>(agreement) / static_cast<double>(both);
  }
};

/// Looks every known cell of `moving` up in `fixed` (nearest cell) under `T_fixed_moving` [m, rad, map
/// frames]. With a `stride` above 1, only every stride-th cell of every stride-th row is looked up, and
/// stands for stride^2 cells. O(cells of moving / stride^2, and once the cells of both to count the known
/// ones).
Agreement measure_agreement(const OccupancyGrid& fixed, const OccupancyGrid& moving,
                            const SE2& T_fixed_moving, int stride = 1);

}  // namespace gridmerge
