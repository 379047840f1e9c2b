// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstddef>

#include "preselect/signature.hpp"

namespace gridmerge::internal {

/// A pose between two grid frames [m, rad], its sine and cosine worked out once. Unlike a ManyPointsTransform
/// it knows its angle, and may be shifted.
struct GridPose {
  double x, y, theta, cos, sin;

  static GridPose of(double x, double y, double theta) {
    return {x, y, theta, std::cos(theta), std::sin(theta)};
  }
  Point2 operator*(const Point2& p) const { return {cos * p.x - sin * p.y + x, sin * p.x + cos * p.y + y}; }
  GridPose inverted() const { return {-(cos * x + sin * y), -(-sin * x + cos * y), -theta, cos, -sin}; }
};

/// What walls of two maps say of a pose, in metres of wall.
struct Tally {
  double seen = 0.0;    ///< lie where the other map has seen
  double met = 0.0;     ///< of these, meet a wall that faces the same side
  double open = 0.0;    ///< of these, lie in the open
  double chance = 0.0;  ///< of these, chance would let meet

  /// How much better than by chance the walls meet, in about its standard deviations.
  double score() const { return (met - chance - 0.5 * open) / std::sqrt(seen + 10.0); }
};

/// The mean of both ways: the walls of each map where the other has seen, of the sampled ones every
/// `step`-th, each for as much wall as it stands for. O(walls / step).
Tally tally_both(const Signature& fixed, const Signature& moving, const GridPose& T_fixed_moving,
                 std::size_t step);

}  // namespace gridmerge::internal
