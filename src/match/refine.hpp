// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "search/exhaustive.hpp"
#include "similarity/evidence.hpp"

namespace gridmerge::internal {

/// Measures how far apart two poses put the moving map.
struct PoseMetric {
  Point2 pivot;         ///< centroid of the moving map's walls [cells, grid frame]
  double radius = 1.0;  ///< root mean square distance of the walls from the pivot [cells], at least 1

  /// Root mean square displacement of the moving map's walls between two poses [cells].
  double displacement(const SE2& a, const SE2& b) const;

  /// `pose` shifted by (dx, dy) [cells] and turned by `turn` [rad] about the pivot.
  SE2 moved(const SE2& pose, double dx, double dy, double turn) const;
};

/// O(walls).
PoseMetric make_pose_metric(const LikelihoodField& moving);

/// A pose between grid frames [cells] and what speaks for it.
struct ScoredPose {
  SE2 T_fixed_moving;
  Evidence evidence;
};

/// What makes one pose better than another on the way.
enum class RankBy {
  amount,   ///< the score: what overlaps much wins
  quality,  ///< the score by what unrelated walls spread it, spread_of(seen_walls): what overlaps little
            ///< may win
};

struct RefineOptions {
  double distinct = 20.0;      ///< poses displaced by less than this are one hypothesis [cells]
  double coarse_cell = 4.0;    ///< spacing of the candidates [cells]
  std::size_t max_poses = 10;  ///< how many distinct poses are returned
  RankBy rank = RankBy::amount;
};

/// The figure by which `rank` orders poses; larger is better.
double rank_of(const Evidence& evidence, RankBy rank);

/// Climbs from the candidates to the local maxima of the evidence, in rounds: few points and many candidates
/// first, many points and few candidates last, with steps from half a coarse cell down to a quarter of a
/// cell. `all_points` judges poses by all walls. Returns distinct poses, best first. `progress` is called
/// with shares of the work in [0, 1]. Deterministic; runs in the calling TBB arena.
std::vector<ScoredPose> refine(const WallEvidence& all_points, const LikelihoodField& moving,
                               const std::vector<PoseCandidate>& candidates, const RefineOptions& options,
                               const std::function<void(double)>& progress = {});

/// The local maximum of the evidence near `start`, by steps from `first_step` to `last_step` [cells].
ScoredPose climb(const WallEvidence& evidence, const PoseMetric& metric, const SE2& start, double first_step,
                 double last_step, double min_sigma = 0.0);

}  // namespace gridmerge::internal
