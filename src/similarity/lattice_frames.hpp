// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gridmerge/grid/occupancy_grid.hpp"

namespace gridmerge::internal {

/// Throws std::invalid_argument unless is_finite().
void check_finite(const SE2& T);

/// Throws std::invalid_argument if they differ by more than 100 times.
void check_resolutions(const OccupancyGrid& fixed, const OccupancyGrid& moving);

/// T_fixedgrid_movinggrid, between the lower-left corners [m], from a transform between map frames.
SE2 between_grids(const OccupancyGrid& fixed, const OccupancyGrid& moving, const SE2& T_fixed_moving);

}  // namespace gridmerge::internal
