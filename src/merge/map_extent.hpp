// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gridmerge/grid/se2.hpp"
#include "internal_export.hpp"

namespace gridmerge::internal {

/// Where a map's known cells are: what it takes to say how far apart two poses put them.
struct MapExtent {
  Point2 centre;        ///< of the known cells [m, map frame]
  double radius = 0.0;  ///< root mean square distance of the known cells from the centre [m]
  double side = 0.0;    ///< of the known cells, the longer one [m]
};

/// How far apart a pair's candidate and the poses of a consistent set may put the maps and still agree [m]:
/// bent maps do not close a cycle exactly.
GRIDMERGE_INTERNAL_EXPORT double agreement_tolerance(const MapExtent& a, const MapExtent& b);

/// Root mean square distance by which two poses of a map of this extent differ [m].
GRIDMERGE_INTERNAL_EXPORT double displacement(const MapExtent& moving, const SE2& a, const SE2& b);

/// How far two ways in which maps a and b may lie differ [m]: the displacement of that map which it moves
/// less. The same whichever of the two is taken for the moving one.
GRIDMERGE_INTERNAL_EXPORT double difference(const MapExtent& a, const MapExtent& b, const SE2& T_a_b,
                                            const SE2& T_a_b_other);

}  // namespace gridmerge::internal
