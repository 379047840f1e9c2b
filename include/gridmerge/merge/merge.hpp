// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "gridmerge/grid/occupancy_grid.hpp"
#include "gridmerge/match/match.hpp"
#include "gridmerge/merge/fuse.hpp"

namespace gridmerge {

struct MergeOptions {
  MatchOptions match;       ///< how each pair is matched; its progress callback is not used
  double resolution = 0.0;  ///< of the merged maps [m]; 0 = the finest among a map's inputs
  /// Called after every comparison with the number of finished ones and of those to be expected in all if
  /// nothing more joined (a join changes the latter), from the calling thread.
  std::function<void(std::size_t, std::size_t)> progress;
};

/// A comparison that was made between two groups of maps, said of one map of each: the first of its group.
struct Join {
  std::size_t fixed = 0;   ///< index of the input map
  std::size_t moving = 0;  ///< index of the input map
  MatchResult match;       ///< T_fixed_moving between the frames of these two input maps
};

struct Member {
  std::size_t map = 0;  ///< index of the input map
  SE2 T_component_map;  ///< takes the map's frame to the component's
};

/// Maps that were joined. The component's frame is the map frame of its first member.
struct Component {
  std::vector<Member> members;
  FusedMap fused;
};

struct MergeResult {
  std::vector<Component> components;  ///< of two or more maps each, most members first
  std::vector<Join> joins;            ///< every comparison made, accepted or refused, in the order made
  std::vector<std::size_t> left_out;  ///< maps that joined nothing, ascending
};

/// How two grids are compared: what merge() asks of match().
using Matcher = std::function<MatchResult(const OccupancyGrid& fixed, const OccupancyGrid& moving)>;

/// Merges `maps` pairwise up a binary tree (Birk & Carpin 2006): (0 + 1), (2 + 3), then their results.
///
/// At every node of the tree all groups of maps below it are tried against each other until nothing more
/// joins, the group with the lowest map first and as the fixed one. Groups that are refused stay apart and
/// are tried again further up, with groups that they have not met; the very same two groups are never
/// compared twice. A group of several maps is compared as the fusion of the original maps at their poses,
/// never as a fusion of fusions, and is fused once more at the end. No map gives an empty result, one map is
/// left out.
///
/// The result does not depend on the number of threads; the order of the maps decides the order of the
/// comparisons. Throws std::invalid_argument for an invalid grid or option, naming the map by its index, and
/// when a merged map would exceed 2^28 cells.
/// At most (k - 1)^2 comparisons for k maps, k * (k - 1) / 2 when nothing joins.
MergeResult merge(const std::vector<OccupancyGrid>& maps, const MergeOptions& options = {});

/// The same with another way to compare two grids; `options.match` is not used.
MergeResult merge(const std::vector<OccupancyGrid>& maps, const MergeOptions& options,
                  const Matcher& matcher);

}  // namespace gridmerge
