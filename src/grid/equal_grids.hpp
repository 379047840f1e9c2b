// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>

#include "gridmerge/grid/occupancy_grid.hpp"

namespace gridmerge::internal {

/// Whether two maps have the same cells, of one size, wherever their origins are, whatever their
/// probabilities. O(cells) if they do, mostly O(1) if not.
inline bool has_equal_cells(const OccupancyGrid& a, const OccupancyGrid& b) {
  return a.width == b.width && a.height == b.height && a.resolution == b.resolution && a.cells == b.cells;
}

/// Whether two maps are the same: cells, probabilities and frame. O(cells).
inline bool are_equal(const OccupancyGrid& a, const OccupancyGrid& b) {
  // A probability that is not known is not a number, which equals nothing.
  const auto same = [](float p, float q) { return p == q || (std::isnan(p) && std::isnan(q)); };
  return has_equal_cells(a, b) && a.origin == b.origin &&
         std::equal(a.probability.begin(), a.probability.end(), b.probability.begin(), b.probability.end(),
                    same);
}

}  // namespace gridmerge::internal
