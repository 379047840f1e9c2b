// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gridmerge/grid/occupancy_grid.hpp"
#include "gridmerge/grid/se2.hpp"
#include "internal_export.hpp"
#include "match/refine.hpp"
#include "similarity/evidence.hpp"

namespace gridmerge::internal {

/// A change of size, a turn and a shift: p_a = scale * R(T.theta) * p_b + (T.x, T.y). Named as SE2 is.
struct ScaledPose {
  SE2 T;
  double scale = 1.0;
};

/// S_a_c = S_a_b * S_b_c.
ScaledPose operator*(const ScaledPose& S_a_b, const ScaledPose& S_b_c);

/// S_b_a.
ScaledPose inverse(const ScaledPose& S_a_b);

/// p_a = S_a_b * p_b.
Point2 operator*(const ScaledPose& S_a_b, const Point2& p_b);

/// Root mean square distance between where two of them put points that lie about `centre`, at a root mean
/// square distance of `radius` from it: in the unit of frame a.
double displacement(const Point2& centre, double radius, const ScaledPose& a, const ScaledPose& b);

/// The map drawn `factor` times as large: its resolution and origin are multiplied. O(cells).
GRIDMERGE_INTERNAL_EXPORT OccupancyGrid scaled(OccupancyGrid map, double factor);

/// Whether the valid map is one still once it is scaled(): neither its resolution nor its origin leaves the
/// limits of validate().
GRIDMERGE_INTERNAL_EXPORT bool is_scalable(const OccupancyGrid& map, double factor);

/// A scaled pose between grid frames [cells] and what speaks for it.
struct ScoredScaledPose {
  ScaledPose pose;
  Evidence evidence;
};

/// The local maximum of the evidence near `start` over shifts, turns and scales, by steps from `first_step`
/// to `last_step` [cells]: a step of scale moves the moving map's walls as far on average as one of turn.
/// Scales stay within `least` and `most`.
ScoredScaledPose climb(const WallEvidence& evidence, const PoseMetric& metric, const ScaledPose& start,
                       double first_step, double last_step, double least, double most);

}  // namespace gridmerge::internal
