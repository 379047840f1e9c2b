// SPDX-License-Identifier: Apache-2.0
#include "merge/alignment.hpp"

#include <algorithm>
#include <memory>
#include <set>

#include "gridmerge/match/match.hpp"
#include "match/drawn_walls.hpp"
#include "match/prepared_map.hpp"
#include "merge/pose_problem.hpp"
#include "merge/wall_error.hpp"

namespace gridmerge::internal {

namespace {

/// Walls are drawn to those of so many other maps.
constexpr std::size_t kDrawnTo = 6;

/// Adds the maps' poses, numbered as they are, what is measured between them, and what is known beforehand.
PoseProblem make_problem(const std::vector<AlignedMap>& maps, const std::vector<RelativePose>& measured,
                         std::size_t held) {
  const auto fixed =
      std::find_if(maps.begin(), maps.end(), [](const AlignedMap& map) { return map.is_fixed(); });
  const bool is_world = fixed != maps.end();
  const SE2 T_frame_group = is_world ? fixed->known_pose->T_world_map * inverse(fixed->T_group_map)
                                     : inverse(maps[held].T_group_map);
  PoseProblem problem(maps.size() + 1);  // with the world's
  for (std::size_t i = 0; i < maps.size(); ++i) {
    const SE2 pose =
        maps[i].is_fixed() ? maps[i].known_pose->T_world_map : T_frame_group * maps[i].T_group_map;
    problem.add_pose(pose, maps[i].extent.centre, maps[i].is_fixed() || (!is_world && i == held));
  }
  for (const RelativePose& relative : measured) problem.add(relative);

  // The world's own pose in the frame, which is the world's only if a map is fixed in it.
  std::optional<std::size_t> world;
  for (std::size_t i = 0; i < maps.size(); ++i) {
    if (!maps[i].known_pose || maps[i].is_fixed()) continue;
    const KnownPose& known = *maps[i].known_pose;
    if (!world) {
      const SE2 T_frame_world = T_frame_group * maps[i].T_group_map * inverse(known.T_world_map);
      world = problem.add_pose(is_world ? SE2{} : T_frame_world, known.T_world_map * maps[i].extent.centre,
                               is_world);
    }
    problem.add({*world, i, known.T_world_map, maps[i].extent.centre, known.sd_position, known.sd_theta});
  }
  return problem;
}

/// The measurements of each map that are the best, of one map or the other.
std::vector<RelativePose> best_measured(std::vector<RelativePose> measured, std::size_t maps) {
  std::stable_sort(measured.begin(), measured.end(), [](const RelativePose& a, const RelativePose& b) {
    return a.sd_position < b.sd_position;
  });
  std::vector<std::size_t> drawn(maps, 0);
  std::vector<RelativePose> best;
  for (const RelativePose& relative : measured) {
    if (drawn[relative.fixed] >= kDrawnTo && drawn[relative.moving] >= kDrawnTo) continue;
    ++drawn[relative.fixed];
    ++drawn[relative.moving];
    best.push_back(relative);
  }
  return best;
}

void add_walls(const std::vector<AlignedMap>& maps, const RelativePose& relative, PoseProblem& problem) {
  const PreparedMap &fixed = *maps[relative.fixed].map, &moving = *maps[relative.moving].map;
  const double cell = working_cell(fixed, moving);
  const double sd = std::max(1.0, relative.sd_position / cell);
  const auto add = [&](std::size_t seen, std::size_t seeing, const LikelihoodField& seen_walls,
                       const LikelihoodField& walls) {
    if (walls.walls.empty()) return;
    problem.add(seen, seeing,
                std::make_unique<WallError>(seen_walls, maps[seen].extent.centre, walls,
                                            maps[seeing].extent.centre, sd));
  };
  const LikelihoodField &fixed_walls = DrawnWalls::of(fixed, cell),
                        &moving_walls = DrawnWalls::of(moving, cell);
  add(relative.fixed, relative.moving, fixed_walls, moving_walls);
  add(relative.moving, relative.fixed, moving_walls, fixed_walls);
}

}  // namespace

std::vector<SE2> align(const std::vector<AlignedMap>& maps, const std::vector<RelativePose>& measured) {
  PoseProblem problem = make_problem(maps, measured, 0);
  for (const RelativePose& relative : best_measured(measured, maps.size()))
    add_walls(maps, relative, problem);
  problem.solve();
  std::vector<SE2> poses;
  for (std::size_t i = 0; i < maps.size(); ++i)
    poses.push_back(maps[i].is_fixed() ? maps[i].known_pose->T_world_map : problem.pose(i));
  return poses;
}

std::vector<std::optional<PoseDeviation>> find_deviations(const std::vector<AlignedMap>& maps,
                                                          const std::vector<RelativePose>& measured,
                                                          std::size_t held) {
  PoseProblem problem = make_problem(maps, measured, held);
  problem.solve();
  std::vector<std::optional<PoseDeviation>> deviations = problem.deviations();
  deviations.resize(maps.size());  // the world's own is no map's
  return deviations;
}

}  // namespace gridmerge::internal
