// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "grid/cell_box.hpp"
#include "gridmerge/grid/occupancy_grid.hpp"
#include "internal_export.hpp"

namespace gridmerge::internal {

/// A box that holds all cells in which a map differs from the one before: of another value or probability.
/// Empty where they are the same. None where the maps do not have the same cells: of another number, size or
/// place. O(cells).
GRIDMERGE_INTERNAL_EXPORT std::optional<CellBox> changed_cells(const OccupancyGrid& before,
                                                               const OccupancyGrid& after);

}  // namespace gridmerge::internal
