// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "gridmerge/export.hpp"
#include "gridmerge/grid/occupancy_grid.hpp"
#include "gridmerge/grid/se2.hpp"
#include "gridmerge/match/match_result.hpp"
#include "gridmerge/search/random_walk.hpp"

namespace gridmerge {

/// How two maps are matched by random walks.
struct RandomWalkMatchOptions {
  StartPoseOptions start;  ///< the grid of poses from which walks start
  /// T_fixed_moving from which all walks start, instead of the best poses of that grid [m, rad].
  std::optional<SE2> start_pose = {};
  /// Of each walk. Its seed is the first walk's, and those of the others are derived from it; its c_lock is
  /// replaced by those below.
  RandomWalkOptions walk;
  /// c_lock of the first, second, ... walk, from the start again when there are more walks.
  std::vector<double> c_locks{0.0};
  int restarts = 1;                       ///< how many walks there are, at least 1
  double accept_acceptance_index = 0.98;  ///< the verdict is `accepted` from this acceptance index on...
  /// ...if so many cells of the fixed map's lattice are known in both: any two maps agree on a handful.
  std::int64_t least_common_cells = 400;
  std::size_t max_hypotheses = 10;  ///< how many distinct hypotheses the result lists
  int threads = 0;                  ///< worker threads; 0 = one per core. The result does not depend on it.
  /// Called now and then with the share of the walks that are finished; never from two threads at once.
  std::function<void(double)> progress;
  /// Called at the end for every walk, in order, with its number from 0 and its c_lock.
  std::function<void(int, double, const RandomWalkResult&)> on_walk;
};

/// Finds how `moving` lies on `fixed` as Birk & Carpin (2006) do: adaptive random walks from a grid of
/// start poses, of which the one with the best acceptance index is kept (of those with the fewest undefined
/// distances), and accepted if that is large enough, no distance is undefined and the maps have enough in
/// common.
///
/// match() calls it for SearchMethod::random_walk. The result is that of the other methods with these
/// differences: a hypothesis's score is its acceptance index; the
/// acceptance index also stands for the probability, for want of one (it is not one: see docs/paper.md);
/// agreement and disagreement are counted on the fixed map's lattice; walks that end within ten cells of each
/// other are one hypothesis. Throws std::invalid_argument for invalid grids or options, and for a start pose
/// that puts the maps apart (lie_on_each_other()).
GRIDMERGE_EXPORT MatchResult match_by_random_walk(const OccupancyGrid& fixed, const OccupancyGrid& moving,
                                                  const RandomWalkMatchOptions& options = {});

/// Throws std::invalid_argument, saying what is wrong, for options that make no sense.
GRIDMERGE_EXPORT void validate(const RandomWalkMatchOptions& options);

}  // namespace gridmerge
