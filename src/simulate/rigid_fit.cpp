// SPDX-License-Identifier: Apache-2.0
#include "simulate/rigid_fit.hpp"

#include <cmath>

namespace gridmerge::internal {

RigidFit fit_rigid(const std::vector<PointPair>& points) {
  if (points.empty()) return {};
  const double count = static_cast<double>(points.size());
  Point2 a, b;
  for (const PointPair& point : points) {
    a = {a.x + point.in_a.x / count, a.y + point.in_a.y / count};
    b = {b.x + point.in_b.x / count, b.y + point.in_b.y / count};
  }
  double dot = 0.0, cross = 0.0;
  for (const PointPair& point : points) {
    const Point2 p{point.in_a.x - a.x, point.in_a.y - a.y};
    const Point2 q{point.in_b.x - b.x, point.in_b.y - b.y};
    dot += q.x * p.x + q.y * p.y;
    cross += q.x * p.y - q.y * p.x;
  }
  RigidFit fit;
  fit.T_a_b.theta = std::atan2(cross, dot);
  const Point2 turned = fit.T_a_b * b;
  fit.T_a_b.x = a.x - turned.x;
  fit.T_a_b.y = a.y - turned.y;
  double sum = 0.0;
  const ManyPointsTransform T_a_b(fit.T_a_b);
  for (const PointPair& point : points) {
    const Point2 at = T_a_b * point.in_b;
    sum += (at.x - point.in_a.x) * (at.x - point.in_a.x) + (at.y - point.in_a.y) * (at.y - point.in_a.y);
  }
  fit.rms = std::sqrt(sum / count);
  return fit;
}

}  // namespace gridmerge::internal
