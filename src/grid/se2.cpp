// SPDX-License-Identifier: Apache-2.0
#include "gridmerge/grid/se2.hpp"

#include <cmath>
#include <numbers>

namespace gridmerge {

double normalize_angle(double angle) {
  const double wrapped = std::remainder(angle, 2.0 * std::numbers::pi);
  return wrapped <= -std::numbers::pi ? std::numbers::pi : wrapped;
}

double undirected_angle(double angle) {
  return 0.5 * normalize_angle(2.0 * angle);
}

SE2 operator*(const SE2& T_a_b, const SE2& T_b_c) {
  const Point2 translation = T_a_b * Point2{T_b_c.x, T_b_c.y};
  return {translation.x, translation.y, normalize_angle(T_a_b.theta + T_b_c.theta)};
}

Point2 operator*(const SE2& T_a_b, const Point2& p_b) {
  return ManyPointsTransform(T_a_b) * p_b;
}

bool is_finite(const SE2& T_a_b) {
  return std::isfinite(T_a_b.x) && std::isfinite(T_a_b.y) && std::isfinite(T_a_b.theta);
}

ManyPointsTransform::ManyPointsTransform(const SE2& T_a_b)
    : cos_(std::cos(T_a_b.theta)), sin_(std::sin(T_a_b.theta)), x_(T_a_b.x), y_(T_a_b.y) {}

SE2 inverse(const SE2& T_a_b) {
  const double c = std::cos(T_a_b.theta);
  const double s = std::sin(T_a_b.theta);
  return {-c * T_a_b.x - s * T_a_b.y, s * T_a_b.x - c * T_a_b.y, normalize_angle(-T_a_b.theta)};
}

}  // namespace gridmerge
