// SPDX-License-Identifier: Apache-2.0
#include "hypotheses.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "gridmerge/grid/cancellation.hpp"
#include "gridmerge/match/walls_met.hpp"
#include "gridmerge/similarity/wall_lines.hpp"

namespace gridmerge {

namespace {

/// Small maps are searched in finer steps, large ones in coarser: the search takes about the same time for
/// all.
constexpr double kCoarseCellsAlongSide = 150.0;
constexpr double kCoarseSigma = 0.8;  // tolerance of the search [coarse cells]
/// Steps of rotation move the walls by so much on average, within bounds.
constexpr double kTurnStep = 2.0;  // coarse cells
constexpr int kLeastRotations = 180;
constexpr int kMostRotations = 720;
/// Poses nearer than this share of the larger map's side, and never less than kMinDistinct, are one
/// hypothesis.
constexpr double kDistinctShare = 0.03;
constexpr double kMinDistinct = 10.0;  // cells
/// About so many cells decide how much of the common area agrees.
constexpr double kRankedCells = 60000.0;
double longer_side(const OccupancyGrid& grid) {
  return std::max(grid.width, grid.height) * grid.resolution;
}

/// The longest side of the two maps [cells].
double longest_side(const ComparedMaps& maps) {
  return std::max(longer_side(maps.fixed), longer_side(maps.moving)) / maps.cell;
}

}  // namespace

ComparedMaps::ComparedMaps(const PreparedMap& fixed_map, const PreparedMap& moving_map)
    : fixed(fixed_map.known()),
      moving(moving_map.known()),
      cell(working_cell(fixed_map, moving_map)),
      fixed_walls(fixed_map.walls(cell)),
      moving_walls(moving_map.walls(cell)) {}

SE2 to_map_frames(const SE2& T_cells, const WallMap& fixed, const WallMap& moving) {
  const SE2 T_metres{T_cells.x * fixed.cell, T_cells.y * fixed.cell, T_cells.theta};
  return fixed.T_map_grid * T_metres * inverse(moving.T_map_grid);
}

SE2 to_cells(const SE2& T_fixed_moving, const WallMap& fixed, const WallMap& moving) {
  const SE2 T_metres = inverse(fixed.T_map_grid) * T_fixed_moving * moving.T_map_grid;
  return {T_metres.x / fixed.cell, T_metres.y / fixed.cell, T_metres.theta};
}

ExhaustiveSearchOptions choose_search(const ComparedMaps& maps) {
  ExhaustiveSearchOptions search;
  search.coarse_factor =
      std::clamp(static_cast<int>(std::ceil(longest_side(maps) / kCoarseCellsAlongSide)), 2, 4);
  search.sigma = kCoarseSigma * search.coarse_factor;
  const double radius = make_pose_metric(maps.moving_walls).radius / search.coarse_factor;
  search.rotations = std::clamp(static_cast<int>(std::ceil(2.0 * std::numbers::pi * radius / kTurnStep)),
                                kLeastRotations, kMostRotations);
  return search;
}

double distinct_displacement(const ComparedMaps& maps) {
  return std::max(kMinDistinct, kDistinctShare * longest_side(maps));
}

RankedPose rank(const ScoredPose& pose, const ComparedMaps& maps) {
  const double known = static_cast<double>(maps.moving.cells.size());
  const int stride = std::max(1, static_cast<int>(std::sqrt(known / kRankedCells)));
  const double cells_per_cell = std::pow(maps.moving.resolution / maps.cell, 2);
  const SE2 T_fixed_moving = to_map_frames(pose.T_fixed_moving, maps.fixed_walls, maps.moving_walls);
  const AgreementCounts common = count_agreement(maps.fixed, maps.moving, T_fixed_moving, stride);
  const double score =
      pose.evidence.score + area_evidence(cells_per_cell * static_cast<double>(common.agreement),
                                          cells_per_cell * static_cast<double>(common.disagreement));
  return {{T_fixed_moving, score, 0.0}, pose.evidence};
}

std::vector<RankedPose> find_hypotheses(const ComparedMaps& maps, std::size_t max_hypotheses,
                                        const std::function<void(double)>& progress) {
  const auto report = [&](double share) {
    if (progress) progress(share);
  };
  report(0.1);
  const ExhaustiveSearchOptions search = choose_search(maps);
  const std::vector<PoseCandidate> candidates = search_all_poses(maps.fixed_walls, maps.moving_walls, search);
  report(0.5);
  RefineOptions refinement;
  refinement.coarse_cell = search.coarse_factor;
  refinement.distinct = distinct_displacement(maps);
  refinement.max_poses = std::max(kRankedPoses, max_hypotheses);
  const std::vector<ScoredPose> poses = refine(maps.fixed_walls, maps.moving_walls, candidates, refinement,
                                               [&](double share) { report(0.5 + 0.45 * share); });
  std::vector<RankedPose> ranked;
  for (const ScoredPose& pose : poses) {
    throw_if_cancelled();
    const RankedPose one = rank(pose, maps);
    if (one.hypothesis.score > 0.0) ranked.push_back(one);
  }
  std::stable_sort(ranked.begin(), ranked.end(), [](const RankedPose& a, const RankedPose& b) {
    return a.hypothesis.score > b.hypothesis.score;
  });
  return ranked;
}

VerdictFeatures measure_features(const RankedPose& pose, double lead, const AgreementCounts& common,
                                 const ComparedMaps& maps) {
  const SE2 T_cells = to_cells(pose.hypothesis.T_fixed_moving, maps.fixed_walls, maps.moving_walls);
  const WallSupport support = measure_wall_support(maps.fixed_walls, maps.moving_walls, T_cells);
  VerdictFeatures features;
  features.lead = lead;
  features.wall_lines = support.lines;
  features.score = pose.hypothesis.score;
  features.nats_per_wall = pose.walls.seen_walls > 0.0 ? pose.walls.score / pose.walls.seen_walls : 0.0;
  features.spread = support.spread * maps.cell;
  features.sigma = pose.walls.model.sigma * maps.cell;
  features.outliers = pose.walls.model.outliers;
  const WallsMet met = measure_walls_met(maps.fixed_walls, maps.moving_walls, T_cells);
  features.walls_met = met.rigidly;
  features.walls_met_locally = met.locally;
  features.acceptance_index = common.acceptance_index();
  features.overlap = measure_overlap(maps.fixed, maps.moving, common);
  features.common_area =
      static_cast<double>(common.both_known()) * maps.moving.resolution * maps.moving.resolution;
  return features;
}

}  // namespace gridmerge
