// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "gridmerge/grid/se2.hpp"

namespace gridmerge::internal {

/// A point in two frames.
struct PointPair {
  Point2 in_a;
  Point2 in_b;
};

struct RigidFit {
  SE2 T_a_b;
  double rms = 0.0;  ///< what is left [m]
};

/// The rigid transform that brings the points nearest to each other in the mean square (Horn 1987, in the
/// plane). The identity for no points. O(points).
RigidFit fit_rigid(const std::vector<PointPair>& points);

}  // namespace gridmerge::internal
