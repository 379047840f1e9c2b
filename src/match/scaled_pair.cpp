// SPDX-License-Identifier: Apache-2.0
#include "match/scaled_pair.hpp"

#include <algorithm>
#include <cmath>

#include "grid/parallel.hpp"
#include "match/drawn_walls.hpp"
#include "match/pair_pose.hpp"
#include "match/prepared_map.hpp"

namespace gridmerge::internal {

namespace {

constexpr std::size_t kSettlingWalls = 2000;
constexpr double kFirstStep = 4.0;           // [cells]
constexpr double kLastSettlingStep = 0.125;  // [cells]

/// A map's grid frame [cells] to its frame [m].
ScaledPose grid_to_map(const LikelihoodField& map) {
  return {map.T_map_grid, map.cell};
}

}  // namespace

ScaledPair::ScaledPair(const PreparedMap& fixed, const PreparedMap& moving, double scale, double cell)
    : scale_(scale),
      moving_(DrawnWalls::scaled(moving, scale)),
      fixed_(fixed),
      swapped_(are_swapped(fixed, moving_)),
      maps_(swapped_ ? moving_ : fixed, swapped_ ? fixed : moving_,
            std::max(cell, working_cell(fixed, moving_))),
      metric_(make_pose_metric(maps_.moving_walls)),
      judge_(maps_) {}

ScaledPose ScaledPair::to_cells(const ScaledPose& pose) const {
  const ScaledPose drawn = pose * ScaledPose{SE2{}, 1.0 / scale_};
  const ScaledPose compared = swapped_ ? inverse(drawn) : drawn;
  return inverse(grid_to_map(maps_.fixed_walls)) * compared * grid_to_map(maps_.moving_walls);
}

ScaledPose ScaledPair::from_cells(const ScaledPose& pose) const {
  const ScaledPose compared =
      grid_to_map(maps_.fixed_walls) * pose * inverse(grid_to_map(maps_.moving_walls));
  return (swapped_ ? inverse(compared) : compared) * ScaledPose{SE2{}, scale_};
}

std::vector<Hypothesis> ScaledPair::look(SearchMethod search, std::size_t count) const {
  LookOptions options;
  options.search = search;
  std::vector<Hypothesis> found = find_hypotheses(maps_, options);
  if (found.size() > count) found.resize(count);
  for (Hypothesis& one : found) {
    if (swapped_) {
      one.T_fixed_moving = gridmerge::inverse(one.T_fixed_moving);
      double& free_direction = one.figures.free_direction;
      free_direction = undirected_angle(free_direction + one.T_fixed_moving.theta);
    }
    one.scale = scale_;
  }
  return found;
}

ScaledPose ScaledPair::settle(const ScaledPose& pose, double reach) const {
  const WallEvidence walls = judge_.walls().with_points(kSettlingWalls);
  return from_cells(
      climb(walls, metric_, to_cells(pose), kFirstStep, kLastSettlingStep, 1.0 / reach, reach).pose);
}

Hypothesis ScaledPair::judge(const SE2& T_fixed_moving) const {
  Hypothesis judged = judge_.judge(to_cells({T_fixed_moving, scale_}).T);
  judged.T_fixed_moving = T_fixed_moving;
  judged.scale = scale_;
  if (swapped_)
    judged.figures.free_direction = undirected_angle(judged.figures.free_direction + T_fixed_moving.theta);
  return judged;
}

void ScaledPair::count_common(PairPose& pose) const {
  internal::count_common(fixed_, moving_, pose);
}

}  // namespace gridmerge::internal
