// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gridmerge/grid/occupancy_grid.hpp"

namespace gridmerge::internal {

/// What rms_displacement() needs to know of a map: how the centres of its known cells lie in the map frame.
struct KnownMoments {
  Point2 centroid;                  ///< [m]; the middle of the grid when the map has no known cell
  double mean_square_radius = 0.0;  ///< mean squared distance from the centroid [m^2]
};

/// O(cells).
KnownMoments known_moments(const OccupancyGrid& map);

/// Root mean square, over the known cells of the moving map, of the distance between where two transforms of
/// it put a cell [m]. Symmetric in the transforms. O(1).
double rms_displacement(const KnownMoments& moving, const SE2& T_estimate, const SE2& T_truth);

}  // namespace gridmerge::internal
