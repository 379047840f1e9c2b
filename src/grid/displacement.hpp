// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include "gridmerge/grid/se2.hpp"

namespace gridmerge::internal {

/// Root mean square distance between where two poses put points that lie about `centre`, at a root mean
/// square distance of `radius` from it. In the unit of both.
inline double displacement(const Point2& centre, double radius, const SE2& a, const SE2& b) {
  const Point2 at_a = a * centre, at_b = b * centre;
  const double dx = at_a.x - at_b.x, dy = at_a.y - at_b.y;
  return std::sqrt(dx * dx + dy * dy + 2.0 * (1.0 - std::cos(a.theta - b.theta)) * radius * radius);
}

}  // namespace gridmerge::internal
