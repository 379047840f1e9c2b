// SPDX-License-Identifier: Apache-2.0
#include "match/scaled_pose.hpp"

#include <algorithm>
#include <cmath>

#include "match/ascend.hpp"

namespace gridmerge::internal {

ScaledPose operator*(const ScaledPose& S_a_b, const ScaledPose& S_b_c) {
  const Point2 shift = S_a_b * Point2{S_b_c.T.x, S_b_c.T.y};
  return {{shift.x, shift.y, normalize_angle(S_a_b.T.theta + S_b_c.T.theta)}, S_a_b.scale * S_b_c.scale};
}

ScaledPose inverse(const ScaledPose& S_a_b) {
  const SE2 T = gridmerge::inverse(S_a_b.T);
  return {{T.x / S_a_b.scale, T.y / S_a_b.scale, T.theta}, 1.0 / S_a_b.scale};
}

Point2 operator*(const ScaledPose& S_a_b, const Point2& p_b) {
  return S_a_b.T * Point2{S_a_b.scale * p_b.x, S_a_b.scale * p_b.y};
}

double displacement(const Point2& centre, double radius, const ScaledPose& a, const ScaledPose& b) {
  const Point2 at_a = a * centre, at_b = b * centre;
  const double dx = at_a.x - at_b.x, dy = at_a.y - at_b.y;
  const double spread =
      a.scale * a.scale + b.scale * b.scale - 2.0 * a.scale * b.scale * std::cos(a.T.theta - b.T.theta);
  return std::sqrt(dx * dx + dy * dy + std::max(0.0, spread) * radius * radius);
}

OccupancyGrid scaled(OccupancyGrid map, double factor) {
  map.resolution *= factor;
  map.origin.x *= factor;
  map.origin.y *= factor;
  return map;
}

bool is_scalable(const OccupancyGrid& map, double factor) {
  const double farthest = std::max(std::abs(map.origin.x), std::abs(map.origin.y));
  return is_resolution(map.resolution * factor) && farthest * factor <= 2.0 * kMaxOrigin;
}

ScoredScaledPose climb(const WallEvidence& evidence, const PoseMetric& metric, const ScaledPose& start,
                       double first_step, double last_step, double least, double most) {
  constexpr int kMaxMoves = 20;
  ScoredScaledPose best{start, evidence(start.T, 0.0, start.scale)};
  const auto moved = [&](const ScaledPose& from, std::size_t move, double step) -> ScaledPose {
    if (move < kRigidMoves) {  // about where the pivot is drawn, which scaling about the origin has moved
      const PoseMetric drawn{{from.scale * metric.pivot.x, from.scale * metric.pivot.y}, metric.radius};
      return {moved_rigidly(drawn, from.T, move, step), from.scale};
    }
    const double scale = from.scale + (move % 2 == 0 ? step : -step) / metric.radius;
    const Point2 kept = from * metric.pivot;
    const Point2 now = ScaledPose{from.T, scale} * metric.pivot;
    return {{from.T.x + kept.x - now.x, from.T.y + kept.y - now.y, from.T.theta}, scale};
  };
  best.pose = ascend_by(kRigidMoves + 2, start, {first_step, last_step, kMaxMoves}, moved,
                        [&](const ScaledPose& pose) {
                          if (!(pose.scale >= least && pose.scale <= most)) return false;
                          const Evidence found = evidence(pose.T, 0.0, pose.scale);
                          const bool is_better = found.score > best.evidence.score;
                          if (is_better) best.evidence = found;
                          return is_better;
                        });
  return best;
}

}  // namespace gridmerge::internal
