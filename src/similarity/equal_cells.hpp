// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "grid/cell_box.hpp"
#include "gridmerge/grid/occupancy_grid.hpp"
#include "internal_export.hpp"

namespace gridmerge::internal {

/// As count_equal_cells() of the cells of a box of the lattice alone. O(k * cells of the box).
GRIDMERGE_INTERNAL_EXPORT std::int64_t count_equal_cells(const OccupancyGrid& lattice,
                                                         std::span<const PlacedMap> maps, const CellBox& box);

}  // namespace gridmerge::internal
