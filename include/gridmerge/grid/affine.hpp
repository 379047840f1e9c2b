// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include "gridmerge/grid/se2.hpp"

namespace gridmerge {

/// An affine function of the plane: p goes to (xx * p.x + xy * p.y + shift.x, yx * p.x + yy * p.y + shift.y).
struct Affine {
  double xx = 1.0;  ///< of x in x
  double xy = 0.0;  ///< of y in x
  double yx = 0.0;  ///< of x in y
  double yy = 1.0;  ///< of y in y
  Point2 shift;     ///< where the origin goes [m]

  /// Where a point goes [m].
  Point2 operator*(const Point2& p) const {
    return {xx * p.x + xy * p.y + shift.x, yx * p.x + yy * p.y + shift.y};
  }
  /// By how much it enlarges areas; negative if it mirrors.
  double determinant() const { return xx * yy - xy * yx; }
  /// By how much it enlarges lengths, in the geometric mean over its two axes: the root of the determinant,
  /// which must not be negative.
  double scale() const { return std::sqrt(determinant()); }
  /// Whether it turns, shifts and enlarges alone: no entry is farther than `tolerance` from such a
  /// function's.
  bool is_similarity(double tolerance = 1e-9) const {
    return std::abs(xx - yy) <= 2.0 * tolerance && std::abs(xy + yx) <= 2.0 * tolerance;
  }

  /// Whether both are the same, to the bit.
  friend bool operator==(const Affine&, const Affine&) = default;
};

}  // namespace gridmerge
