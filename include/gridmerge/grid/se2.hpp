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
/// translation (`x`, `y`) (Birk & Carpin 2006, eq. 1). Metres and radians; what operators and functions give
/// has `theta` in (-pi, pi]. Named after its frames: `T_a_b` takes a point given in frame b to frame a.
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

/// Whether all three numbers of a transform are finite.
GRIDMERGE_EXPORT bool is_finite(const SE2& T_a_b);

/// A transform for many points, or many products: its sine and cosine are computed once. Points go where the
/// SE2 takes them, to the bit; products and inverses are those of the SE2s, to rounding.
class GRIDMERGE_EXPORT ManyPointsTransform {
 public:
  /// Takes points of frame b to frame a.
  explicit ManyPointsTransform(const SE2& T_a_b);

  /// The cosine of the rotation.
  double cos() const { return cos_; }

  /// The sine of the rotation.
  double sin() const { return sin_; }

  /// p_a.
  Point2 operator*(const Point2& p_b) const {
    return {cos_ * p_b.x - sin_ * p_b.y + x_, sin_ * p_b.x + cos_ * p_b.y + y_};
  }

  /// T_a_c = T_a_b * T_b_c.
  ManyPointsTransform operator*(const ManyPointsTransform& T_b_c) const {
    const Point2 translation = *this * Point2{T_b_c.x_, T_b_c.y_};
    return {cos_ * T_b_c.cos_ - sin_ * T_b_c.sin_, sin_ * T_b_c.cos_ + cos_ * T_b_c.sin_, translation.x,
            translation.y};
  }

  /// T_b_a.
  ManyPointsTransform inverse() const { return {cos_, -sin_, -cos_ * x_ - sin_ * y_, sin_ * x_ - cos_ * y_}; }

 private:
  ManyPointsTransform(double cos, double sin, double x, double y) : cos_(cos), sin_(sin), x_(x), y_(y) {}

  double cos_;
  double sin_;
  double x_;
  double y_;
};

}  // namespace gridmerge
