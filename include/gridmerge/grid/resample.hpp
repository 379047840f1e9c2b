// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gridmerge/export.hpp"
#include "gridmerge/grid/occupancy_grid.hpp"
#include "gridmerge/grid/se2.hpp"

namespace gridmerge {

/// The smallest sub-grid that holds every known cell; its origin moves along, so points keep their
/// coordinates in the map frame. A grid with no known cell becomes a single unknown cell. Throws
/// std::invalid_argument for an invalid grid. O(cells).
GRIDMERGE_EXPORT OccupancyGrid crop_to_known(const OccupancyGrid& grid);

/// The grid with cells `factor` times as large (factor >= 1): occupied where any of the factor x factor cells
/// is, else free where any is, else unknown. Same origin. Probabilities are dropped. Its resolution may be
/// beyond what a map may have (see is_resolution()): it is for looking at. Throws std::invalid_argument when
/// the factor is below 1, and for an invalid grid. O(cells).
GRIDMERGE_EXPORT OccupancyGrid downsample(const OccupancyGrid& grid, int factor);

/// The grid seen from another frame: T_target_map is applied to the map, and the result is drawn on an
/// upright (yaw 0) grid of `resolution` that just holds it. Every target cell takes the value of the source
/// cell under its centre (nearest cell); probabilities are dropped. Throws std::invalid_argument for an
/// invalid grid, a transform that is not finite, a resolution that is no map's (see is_resolution()), and a
/// result of more than kMaxGridCells. O(result cells).
GRIDMERGE_EXPORT OccupancyGrid transform_grid(const OccupancyGrid& grid, const SE2& T_target_map,
                                              double resolution);

}  // namespace gridmerge
