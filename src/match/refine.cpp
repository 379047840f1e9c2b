// SPDX-License-Identifier: Apache-2.0
#include "match/refine.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "grid/displacement.hpp"
#include "grid/parallel.hpp"
#include "gridmerge/grid/execution.hpp"
#include "match/ascend.hpp"
#include "search/thorough.hpp"

namespace gridmerge::internal {

namespace {

constexpr std::size_t kAll = std::numeric_limits<std::size_t>::max();

/// One pass over the surviving poses.
struct Round {
  std::size_t points;  // wall points of each map that are looked at
  std::size_t poses;   // how many of the best poses are climbed from
  double first_step;   // [coarse cells]
  double last_step;    // [cells]
  double min_sigma;    // [coarse cells]
  double distinct;     // poses nearer than this afterwards are one [cells]
};

/// Many candidates, few of which are near a pose with much in common: they are thinned by score, which is
/// cheap, and the rest is climbed from.
std::array<Round, 4> rounds_by_amount(double coarse, const RefineOptions& options) {
  return {{
      {150, kAll, 0.0, 1.0, 0.35, 0.0},                  // score only
      {200, 75, 0.5, coarse / 4.0, 0.35, coarse / 4.0},  // into the basin
      {400, 30, 0.25, 1.0, 0.0, coarse / 2.0},           // the error model settles
      {1000, 2 * options.max_poses, 0.25, 0.25, 0.0, options.distinct},
  }};
}

/// Where little overlaps, a pose a step beside the true one looks like any other: all are climbed from.
std::array<Round, 4> rounds_by_quality(double coarse, const RefineOptions& options) {
  return {{
      {200, kAll, 0.5, coarse / 2.0, 0.35, coarse / 2.0},
      {300, 200, 0.25, coarse / 4.0, 0.35, coarse / 2.0},
      {600, 100, 0.25, 1.0, 0.0, coarse / 2.0},
      {1000, 2 * options.max_poses, 0.25, 0.5, 0.0, options.distinct},
  }};
}

/// Best first. The sort is stable, so equal ranks keep the order of the search and the result is
/// deterministic.
void sort_by(RankBy rank, std::vector<ScoredPose>& poses) {
  std::stable_sort(poses.begin(), poses.end(), [rank](const ScoredPose& a, const ScoredPose& b) {
    return rank_of(a.evidence, rank) > rank_of(b.evidence, rank);
  });
}

std::vector<ScoredPose> keep_distinct(std::vector<ScoredPose> poses, const PoseMetric& metric,
                                      double distinct, RankBy rank) {
  sort_by(rank, poses);
  if (distinct <= 0.0) return poses;
  std::vector<ScoredPose> kept;
  for (const ScoredPose& pose : poses) {
    const bool is_new = std::none_of(kept.begin(), kept.end(), [&](const ScoredPose& other) {
      return metric.displacement(pose.T_fixed_moving, other.T_fixed_moving) < distinct;
    });
    if (is_new) kept.push_back(pose);
  }
  return kept;
}

}  // namespace

double rank_of(const Evidence& evidence, RankBy rank) {
  if (rank == RankBy::amount) return evidence.score;
  return evidence.score / spread_of(std::max(1.0, evidence.seen_walls));
}

double PoseMetric::displacement(const SE2& a, const SE2& b) const {
  return internal::displacement(pivot, radius, a, b);
}

SE2 PoseMetric::moved(const SE2& pose, double dx, double dy, double turn) const {
  const Point2 before = pose * pivot;
  const SE2 turned{0.0, 0.0, normalize_angle(pose.theta + turn)};
  const Point2 after = turned * pivot;
  return {before.x + dx - after.x, before.y + dy - after.y, turned.theta};
}

PoseMetric make_pose_metric(const LikelihoodField& moving) {
  PoseMetric metric;
  if (moving.walls.empty()) return metric;
  for (const WallPoint& wall : moving.walls) {
    metric.pivot.x += wall.position.x;
    metric.pivot.y += wall.position.y;
  }
  const double count = static_cast<double>(moving.walls.size());
  metric.pivot.x /= count;
  metric.pivot.y /= count;
  double sum = 0.0;
  for (const WallPoint& wall : moving.walls) {
    const double dx = wall.position.x - metric.pivot.x;
    const double dy = wall.position.y - metric.pivot.y;
    sum += dx * dx + dy * dy;
  }
  metric.radius = std::max(1.0, std::sqrt(sum / count));
  return metric;
}

ScoredPose climb(const WallEvidence& evidence, const PoseMetric& metric, const SE2& start, double first_step,
                 double last_step, double min_sigma) {
  constexpr int kMaxMoves = 20;  // far more than a climb between neighbouring candidates takes
  ScoredPose best{start, evidence(start, min_sigma)};
  best.T_fixed_moving = ascend(metric, start, {first_step, last_step, kMaxMoves}, [&](const SE2& pose) {
    const Evidence found = evidence(pose, min_sigma);
    const bool is_better = found.score > best.evidence.score;
    if (is_better) best.evidence = found;
    return is_better;
  });
  return best;
}

std::vector<ScoredPose> refine(const WallEvidence& all_points, const LikelihoodField& moving,
                               const std::vector<PoseCandidate>& candidates, const RefineOptions& options,
                               const std::function<void(double)>& progress) {
  const double coarse = options.coarse_cell;
  const std::array<Round, 4> rounds =
      options.rank == RankBy::amount ? rounds_by_amount(coarse, options) : rounds_by_quality(coarse, options);

  const PoseMetric metric = make_pose_metric(moving);
  std::vector<ScoredPose> poses;
  poses.reserve(candidates.size());
  for (const PoseCandidate& candidate : candidates) poses.push_back({candidate.T_fixed_moving, {}});

  for (std::size_t r = 0; r < rounds.size(); ++r) {
    const Round& round = rounds[r];
    const WallEvidence evidence = all_points.with_points(round.points);
    poses.resize(std::min(poses.size(), round.poses));
    parallel_for(poses.size(), [&](std::size_t i) {
      poses[i] = climb(evidence, metric, poses[i].T_fixed_moving, round.first_step * coarse, round.last_step,
                       round.min_sigma * coarse);
    });
    poses = keep_distinct(std::move(poses), metric, round.distinct, options.rank);
    if (progress) progress(static_cast<double>(r + 1) / rounds.size());
  }
  if (poses.size() > options.max_poses) poses.resize(options.max_poses);

  for (ScoredPose& pose : poses) {
    throw_if_cancelled();
    pose.evidence = all_points(pose.T_fixed_moving);
  }
  sort_by(options.rank, poses);
  return poses;
}

}  // namespace gridmerge::internal
