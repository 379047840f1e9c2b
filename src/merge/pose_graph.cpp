// SPDX-License-Identifier: Apache-2.0
#include "pose_graph.hpp"

#include <ceres/ceres.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "relative_pose_error.hpp"

namespace gridmerge {

RelativePose measured_between(std::size_t fixed, std::size_t moving, const SE2& T_fixed_moving,
                              const MapExtent& fixed_extent, const MapExtent& moving_extent,
                              double sd_position) {
  constexpr double kLeastRadius = 1.0;  // [m]: of maps of next to nothing
  const Point2 there = inverse(T_fixed_moving) * fixed_extent.centre;
  const Point2 middle{0.5 * (moving_extent.centre.x + there.x), 0.5 * (moving_extent.centre.y + there.y)};
  const double radius = std::hypot(fixed_extent.radius, moving_extent.radius) / std::sqrt(2.0);
  return {fixed, moving, T_fixed_moving, middle, std::max(kLeastRadius, radius), sd_position};
}

std::vector<SE2> adjust_poses(std::vector<SE2> poses, const std::vector<RelativePose>& relative) {
  std::vector<std::array<double, 3>> parameters;
  for (const SE2& pose : poses) parameters.push_back({pose.x, pose.y, pose.theta});
  ceres::Problem problem;
  for (const RelativePose& measured : relative) {
    problem.AddResidualBlock(RelativePoseError::make(measured), new ceres::HuberLoss(1.0),
                             parameters[measured.fixed].data(), parameters[measured.moving].data());
  }
  if (problem.HasParameterBlock(parameters.front().data()))
    problem.SetParameterBlockConstant(parameters.front().data());
  solve(problem);
  for (std::size_t i = 0; i < poses.size(); ++i)
    poses[i] = {parameters[i][0], parameters[i][1], normalize_angle(parameters[i][2])};
  return poses;
}

}  // namespace gridmerge
