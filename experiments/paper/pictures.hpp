// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "gridmerge/grid/occupancy_grid.hpp"
#include "maps.hpp"

namespace gridmerge::paper {

/// A picture as in the paper: free green, occupied red, unknown white. The bytes of a PNG.
std::string draw(const OccupancyGrid& map);

/// The same of maps that are fused. There must be one.
std::string draw_placed(const std::vector<PlacedMap>& maps);

/// The two maps of a pair, the moving one placed at `T_fixed_moving`.
std::string draw_merged(const Pair& pair, const SE2& T_fixed_moving);

}  // namespace gridmerge::paper
