// SPDX-License-Identifier: Apache-2.0
#include "merge/pose_graph.hpp"

#include <algorithm>
#include <cmath>

#include "merge/pose_problem.hpp"

namespace gridmerge::internal {

RelativePose measured_between(std::size_t fixed, std::size_t moving, const SE2& T_fixed_moving,
                              const MapExtent& fixed_extent, const MapExtent& moving_extent, double sd) {
  constexpr double kMinRadius = 1.0;  // [m]: of maps of next to nothing
  const Point2 there = inverse(T_fixed_moving) * fixed_extent.centre;
  const Point2 middle{0.5 * (moving_extent.centre.x + there.x), 0.5 * (moving_extent.centre.y + there.y)};
  const double radius = std::hypot(fixed_extent.radius, moving_extent.radius) / std::sqrt(2.0);
  return {fixed, moving, T_fixed_moving, middle, sd, sd / std::max(kMinRadius, radius)};
}

std::vector<SE2> adjust_poses(const std::vector<AdjustablePose>& poses,
                              const std::vector<RelativePose>& measured) {
  PoseProblem problem(poses.size());
  for (const AdjustablePose& pose : poses) problem.add_pose(pose.pose, pose.middle, pose.held);
  for (const RelativePose& relative : measured) problem.add(relative);
  problem.solve();
  std::vector<SE2> adjusted;
  for (std::size_t i = 0; i < poses.size(); ++i)
    adjusted.push_back(poses[i].held ? poses[i].pose : problem.pose(i));
  return adjusted;
}

}  // namespace gridmerge::internal
