// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gridmerge/grid/occupancy_grid.hpp"

namespace gridmerge {

/// A map, and the transform that takes its frame to the output's.
struct PlacedMap {
  const OccupancyGrid* map = nullptr;  ///< not owned; outlives its use
  SE2 T_output_map;
};

}  // namespace gridmerge
