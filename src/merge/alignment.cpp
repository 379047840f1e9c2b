// SPDX-License-Identifier: Apache-2.0
#include "alignment.hpp"

#include <ceres/ceres.h>
#include <ceres/covariance.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>

#include "gridmerge/match/match.hpp"
#include "relative_pose_error.hpp"
#include "wall_error.hpp"

namespace gridmerge {

namespace {

using Parameters = std::array<double, 3>;  // x, y, theta

/// Where the first map with a fixed pose says that the group's frame lies in the world; the frame of the map
/// at `held` if there is none.
SE2 find_frame(const std::vector<AlignedMap>& maps, std::size_t held) {
  for (const AlignedMap& map : maps) {
    if (map.known_pose && map.known_pose->fixed)
      return map.known_pose->T_world_map * inverse(map.T_group_map);
  }
  return inverse(maps[held].T_group_map);
}

class Adjustment {
 public:
  /// Without a fixed map, the one at `held` holds the frame.
  Adjustment(const std::vector<AlignedMap>& maps, const std::vector<RelativePose>& measured, std::size_t held)
      : maps_(maps) {
    const SE2 T_frame_group = find_frame(maps, held);
    for (const AlignedMap& map : maps) {
      const bool is_fixed = map.known_pose && map.known_pose->fixed;
      const SE2 pose = is_fixed ? map.known_pose->T_world_map : T_frame_group * map.T_group_map;
      held_.push_back(is_fixed);
      parameters_.push_back({pose.x, pose.y, pose.theta});
    }
    is_world_ = std::find(held_.begin(), held_.end(), true) != held_.end();
    if (!is_world_) held_[held] = true;
    for (Parameters& pose : parameters_) problem_.AddParameterBlock(pose.data(), 3);
    for (const RelativePose& relative : measured) add(relative);
    add_known_poses();
    for (std::size_t i = 0; i < held_.size(); ++i) {
      if (held_[i]) problem_.SetParameterBlockConstant(parameters_[i].data());
    }
  }

  void add_walls(const std::vector<RelativePose>& measured) {
    for (const RelativePose& relative : measured) add_walls(relative);
  }

  std::vector<SE2> poses() {
    solve(problem_);
    std::vector<SE2> poses;
    for (const Parameters& pose : parameters_) poses.push_back({pose[0], pose[1], normalize_angle(pose[2])});
    return poses;
  }

  std::vector<PoseDeviation> deviations() {
    solve(problem_);
    std::vector<PoseDeviation> deviations(parameters_.size());
    std::vector<std::pair<const double*, const double*>> blocks;
    for (std::size_t i = 0; i < held_.size(); ++i) {
      if (!held_[i]) blocks.emplace_back(parameters_[i].data(), parameters_[i].data());
    }
    ceres::Covariance::Options options;
    options.algorithm_type = ceres::DENSE_SVD;
    options.num_threads = 1;
    ceres::Covariance covariance(options);
    if (blocks.empty() || !covariance.Compute(blocks, &problem_)) return deviations;
    for (std::size_t i = 0; i < held_.size(); ++i) {
      if (!held_[i]) deviations[i] = deviation_of(covariance, i);
    }
    return deviations;
  }

 private:
  void add(const RelativePose& relative) {
    problem_.AddResidualBlock(RelativePoseError::make(relative), new ceres::HuberLoss(1.0),
                              parameters_[relative.fixed].data(), parameters_[relative.moving].data());
  }

  void add_walls(const RelativePose& relative) {
    const PreparedMap &fixed = *maps_[relative.fixed].map, &moving = *maps_[relative.moving].map;
    const double cell = working_cell(fixed, moving);
    const WallMap &fixed_walls = fixed.walls(cell), &moving_walls = moving.walls(cell);
    const double sd = std::max(1.0, relative.sd_position / cell);
    add_walls(relative.fixed, relative.moving, fixed_walls, moving_walls, sd);
    add_walls(relative.moving, relative.fixed, moving_walls, fixed_walls, sd);
  }

  void add_walls(std::size_t fixed, std::size_t moving, const WallMap& fixed_walls,
                 const WallMap& moving_walls, double sd) {
    auto error = std::make_unique<WallError>(fixed_walls, moving_walls, sd);
    if (error->empty()) return;
    problem_.AddResidualBlock(error.release(), nullptr, parameters_[fixed].data(),
                              parameters_[moving].data());
  }

  /// In the world's frame a known pose pulls by itself. Otherwise only what two of them say of each other
  /// counts: each is held against the first one.
  void add_known_poses() {
    std::optional<std::size_t> first;
    for (std::size_t i = 0; i < maps_.size(); ++i) {
      if (!maps_[i].known_pose) continue;
      const std::size_t from = is_world_ ? held_place() : first.value_or(i);
      if (!first) first = i;
      if (from == i || held_[i]) continue;
      const KnownPose& origin = *maps_[from].known_pose;
      const double sd = std::hypot(sd_of_known(i), is_world_ ? 0.0 : sd_of_known(from));
      add(measured_between(from, i, inverse(origin.T_world_map) * maps_[i].known_pose->T_world_map,
                           maps_[from].extent, maps_[i].extent, sd));
    }
  }

  std::size_t held_place() const {
    return static_cast<std::size_t>(std::find(held_.begin(), held_.end(), true) - held_.begin());
  }

  double sd_of_known(std::size_t place) const {
    const KnownPose& known = *maps_[place].known_pose;
    return std::hypot(known.sd_position, known.sd_theta * maps_[place].extent.radius);
  }

  /// Of the map's centre, where the pose is known best, not of the frame's origin.
  PoseDeviation deviation_of(const ceres::Covariance& covariance, std::size_t place) const {
    const double* pose = parameters_[place].data();
    std::array<double, 9> block{};
    covariance.GetCovarianceBlock(pose, pose, block.data());
    const Point2 turned = SE2{0.0, 0.0, pose[2]} * maps_[place].extent.centre;
    const double dx = -turned.y, dy = turned.x;  // of the centre, by theta
    const double xx = block[0] + 2.0 * dx * block[2] + dx * dx * block[8];
    const double yy = block[4] + 2.0 * dy * block[5] + dy * dy * block[8];
    return {std::sqrt(std::max(0.0, xx + yy)), std::sqrt(std::max(0.0, block[8]))};
  }

  const std::vector<AlignedMap>& maps_;
  std::vector<Parameters> parameters_;
  std::vector<bool> held_;
  bool is_world_ = false;
  ceres::Problem problem_;
};

}  // namespace

std::vector<SE2> align(const std::vector<AlignedMap>& maps, const std::vector<RelativePose>& measured) {
  Adjustment adjustment(maps, measured, 0);
  adjustment.add_walls(measured);
  return adjustment.poses();
}

std::vector<PoseDeviation> find_deviations(const std::vector<AlignedMap>& maps,
                                           const std::vector<RelativePose>& measured, std::size_t held) {
  return Adjustment(maps, measured, held).deviations();
}

}  // namespace gridmerge
