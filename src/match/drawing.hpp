// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gridmerge/grid/occupancy_grid.hpp"
#include "internal_export.hpp"

namespace gridmerge::internal {

/// Whether a grid is a drawing of walls, and no map: it has walls, but no cell of it is free; or it is free
/// along its whole rim, as white paper is, and what is unknown in it is thin, as gray lines and the soft
/// edges of black ones are: all lines may be gray, and thick then. O(cells).
GRIDMERGE_INTERNAL_EXPORT bool is_drawing(const OccupancyGrid& grid);

/// A drawing as a map: gray lines are walls too; what walls enclose is free, and what lies outside is
/// unknown. Gaps of the outline are closed for that, the least that encloses half of the walls' bounding box:
/// up to 8 % of its longer side. If none does, what the widest closing encloses. A closing that takes a
/// raster of more than 2^28 cells is not tried, nor are wider ones. Any other grid as it is. O(cells).
GRIDMERGE_INTERNAL_EXPORT OccupancyGrid with_enclosed_free(const OccupancyGrid& grid);

}  // namespace gridmerge::internal
