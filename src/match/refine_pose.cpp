// SPDX-License-Identifier: Apache-2.0
#include "match/refine_pose.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "gridmerge/match/match.hpp"
#include "match/drawn_walls.hpp"
#include "match/looks.hpp"
#include "match/pair_pose.hpp"
#include "match/prepared_map.hpp"
#include "similarity/lattice_frames.hpp"

namespace gridmerge {

using namespace internal;

namespace {

constexpr double kShiftReach = 1.0;   // [m] along either axis
constexpr double kTurnReach = 0.125;  // [rad]
/// No further than this on either side, in steps between poses: with cells of less than 2 cm, or maps of more
/// than 8000 cells, there would be no end of poses.
constexpr int kMaxShifts = 25;
constexpr int kMaxTurns = 128;
/// Maxima that are ranked. Those of the walls are not always those of walls and area together.
constexpr std::size_t kMaxima = 6;
constexpr double kDistinctMaxima = 2.0;  // [cells]

/// The start first, so that it stays where nothing speaks for any pose; then poses around it, as dense as
/// those from which match() climbs.
std::vector<PoseCandidate> poses_around(const SE2& start, const ComparedMaps& maps, double spacing) {
  const PoseMetric metric = make_pose_metric(maps.moving_walls);
  const double shift_reach = std::min(kShiftReach / maps.cell, kMaxShifts * spacing);
  const double turn_reach = std::min(kTurnReach, kMaxTurns * spacing / metric.radius);
  const int shifts = static_cast<int>(std::ceil(shift_reach / spacing));
  const int turns = static_cast<int>(std::ceil(turn_reach * metric.radius / spacing));
  std::vector<PoseCandidate> poses{{start, 0}};
  for (int turn = -turns; turn <= turns; ++turn) {
    for (int row = -shifts; row <= shifts; ++row) {
      for (int column = -shifts; column <= shifts; ++column) {
        const SE2 T =
            metric.moved(start, column * spacing, row * spacing, turn * turn_reach / std::max(turns, 1));
        poses.push_back({T, 0});
      }
    }
  }
  return poses;
}

Hypothesis best_around(const Hypothesis& start, const SE2& T_start_cells, const ComparedMaps& maps,
                       const PoseJudge& judge) {
  RefineOptions options;
  options.coarse_cell = choose_search(maps).coarse_factor;
  options.distinct = kDistinctMaxima;
  options.max_poses = kMaxima;
  Hypothesis best = start;
  for (const ScoredPose& pose : refine(judge.walls(), maps.moving_walls,
                                       poses_around(T_start_cells, maps, options.coarse_cell), options)) {
    const Hypothesis judged = judge.judge(pose.T_fixed_moving);
    if (judged.score > best.score) best = judged;
  }
  return best;
}

/// Gives the pose the probability and the margin that it would have among the hypotheses of a full search,
/// those aside that are the same pose. No probability if nothing speaks for it.
void weigh_among_all(Hypothesis& pose, const ComparedMaps& maps) {
  const PoseMetric metric = make_pose_metric(maps.moving_walls);
  const auto in_cells = [&](const Hypothesis& one) {
    return to_cells(one.T_fixed_moving, maps.fixed_walls, maps.moving_walls);
  };
  std::vector<Hypothesis> all{pose};
  for (const Hypothesis& other : find_hypotheses(maps)) {
    if (metric.displacement(in_cells(pose), in_cells(other)) >= distinct_displacement(maps))
      all.push_back(other);
  }
  const std::vector<PoseFigures> figures = compared_figures(all, maps);
  pose.figures = figures.front();
  if (pose.score > 0.0) pose.probability = probabilities_of(figures).front();
}

double displacement(const PreparedMap& fixed, const PreparedMap& moving, const SE2& T_a, const SE2& T_b) {
  const double cell = working_cell(fixed, moving);
  const LikelihoodField& fixed_walls = DrawnWalls::of(fixed, cell);
  const LikelihoodField& moving_walls = DrawnWalls::of(moving, cell);
  return cell * make_pose_metric(moving_walls)
                    .displacement(to_cells(T_a, fixed_walls, moving_walls),
                                  to_cells(T_b, fixed_walls, moving_walls));
}

}  // namespace

RefinedPose refine_pose(const PreparedMap& fixed, const PreparedMap& moving, const SE2& T_start) {
  check_finite(T_start);
  const bool swapped = are_swapped(fixed, moving);
  const ComparedMaps maps(swapped ? moving : fixed, swapped ? fixed : moving);
  const SE2 T_start_maps = swapped ? inverse(T_start) : T_start;
  const SE2 T_start_cells = to_cells(T_start_maps, maps.fixed_walls, maps.moving_walls);
  const PoseJudge judge(maps);
  const Hypothesis start = judge.judge(T_start_cells);
  Hypothesis best = best_around(start, T_start_cells, maps, judge);

  RefinedPose refined;
  refined.start_score = start.score;
  refined.score = best.score;
  const bool is_better = refined.score > refined.start_score;
  const SE2 T_maps = is_better ? best.T_fixed_moving : T_start_maps;
  refined.T_fixed_moving = T_maps;
  count_common(maps.fixed, maps.moving, refined);
  refined.T_fixed_moving = !is_better ? T_start : swapped ? inverse(T_maps) : T_maps;
  if (is_better) refined.moved = displacement(fixed, moving, T_start, refined.T_fixed_moving);
  if (best.score > 0.0) weigh_among_all(best, maps);
  refined.probability = best.probability;
  return refined;
}

Hypothesis internal::judge_pose(const PreparedMap& fixed, const PreparedMap& moving,
                                const SE2& T_fixed_moving) {
  check_finite(T_fixed_moving);
  const bool swapped = are_swapped(fixed, moving);
  const ComparedMaps maps(swapped ? moving : fixed, swapped ? fixed : moving);
  const SE2 T_maps = swapped ? inverse(T_fixed_moving) : T_fixed_moving;
  Hypothesis pose = PoseJudge(maps).judge(to_cells(T_maps, maps.fixed_walls, maps.moving_walls));
  weigh_among_all(pose, maps);
  pose.T_fixed_moving = T_fixed_moving;
  if (swapped)
    pose.figures.free_direction = undirected_angle(pose.figures.free_direction + T_fixed_moving.theta);
  return pose;
}

}  // namespace gridmerge
