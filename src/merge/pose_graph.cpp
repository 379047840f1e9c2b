// SPDX-License-Identifier: Apache-2.0
#include "pose_graph.hpp"

#include <ceres/ceres.h>

#include <array>
#include <cmath>

#include "relative_pose_error.hpp"

namespace gridmerge {

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
