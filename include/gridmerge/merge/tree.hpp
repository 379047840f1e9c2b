// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "gridmerge/export.hpp"
#include "gridmerge/grid/occupancy_grid.hpp"
#include "gridmerge/match/match_result.hpp"
#include "gridmerge/merge/merge_result.hpp"

namespace gridmerge {

/// How two grids are compared: what merge_up_tree() asks of match().
using Matcher = std::function<MatchResult(const OccupancyGrid& fixed, const OccupancyGrid& moving)>;

/// How maps are merged up a tree.
struct TreeOptions {
  /// As MergeOptions::resolution.
  double resolution = 0.0;
  /// Called after every comparison with the number of finished ones and of those to be expected in all if
  /// nothing more joined (a join changes the latter), from the calling thread.
  std::function<void(std::size_t, std::size_t)> progress = {};
  /// As MatchOptions::threads: of what is done beside the comparisons. Throws std::invalid_argument below 0.
  int threads = 0;
};

/// Merges `maps` pairwise up a binary tree (Birk & Carpin 2006): (0 + 1), (2 + 3), then their results.
///
/// At every node of the tree all groups of maps below it are tried against each other until nothing more
/// joins, the group with the lowest map first and as the fixed one. Groups that are refused stay apart and
/// are tried again further up, with groups that they have not met; the very same two groups are never
/// compared twice. A group of several maps is compared as the fusion of the original maps at their poses,
/// never as a fusion of fusions, and is fused once more at the end. No map gives an empty result, one map is
/// left out. A wrong join is never taken back: see merge() for what does better.
///
/// The result does not depend on the number of threads; the order of the maps decides the order of the
/// comparisons, which is that of `joins`. Throws std::invalid_argument for an invalid grid or option, naming
/// the map by its index, and when a merged map would exceed kMaxGridCells.
/// At most (k - 1)^2 comparisons for k maps, k * (k - 1) / 2 when nothing joins.
GRIDMERGE_EXPORT MergeResult merge_up_tree(const std::vector<OccupancyGrid>& maps, const Matcher& matcher,
                                           const TreeOptions& options = {});

}  // namespace gridmerge
