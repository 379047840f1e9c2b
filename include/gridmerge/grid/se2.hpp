// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gridmerge/export.hpp"

namespace gridmerge {

/// A point of the plane, in metres, in the frame that its context names.
struct Point2 {
  double x = 0.0;  ///< [m]
  double y = 0.0;  ///< [m]

  /// Whether both coordinates are equal.
  friend bool operator==(const Point2&, const Point2&) = default;
};

/// A rigid transform of the plane: a counter-clockwise rotation by `theta` about the origin, then the
/// translation
/// (`x`, `y`) (Birk & Carpin 2006, eq. 1). Metres and radians; `theta` is kept in (-pi, pi].
/// Named after its frames: `T_a_b` takes a point given in frame b to frame a.
struct SE2 {
  double x = 0.0;      ///< [m]
  double y = 0.0;      ///< [m]
  double theta = 0.0;  ///< [rad]

  /// Whether all three are equal.
  friend bool operator==(const SE2&, const SE2&) = default;
};

/// The same angle [rad] in (-pi, pi].
GRIDMERGE_EXPORT double normalize_angle(double angle);

/// The angle of a line, which has no direction [rad]: the same in (-pi/2, pi/2].
GRIDMERGE_EXPORT double undirected_angle(double angle);

/// T_a_c = T_a_b * T_b_c.
GRIDMERGE_EXPORT SE2 operator*(const SE2& T_a_b, const SE2& T_b_c);

/// p_a = T_a_b * p_b.
GRIDMERGE_EXPORT Point2 operator*(const SE2& T_a_b, const Point2& p_b);

/// T_b_a.
GRIDMERGE_EXPORT SE2 inverse(const SE2& T_a_b);

/// A transform for many points: its sine and cosine are computed once. To the bit as with the SE2.
class GRIDMERGE_EXPORT ManyPointsTransform {
 public:
  /// Takes points of frame b to frame a.
  explicit ManyPointsTransform(const SE2& T_a_b);

  /// p_a.
  Point2 operator*(const Point2& p_b) const {
    return {cos_ * p_b.x - sin_ * p_b.y + x_, sin_ * p_b.x + cos_ * p_b.y + y_};
  }

 private:
  double cos_;
  double sin_;
  double x_;
  double y_;
};

}  // namespace gridmerge
