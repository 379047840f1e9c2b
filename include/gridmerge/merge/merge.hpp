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
  double resolution = 0.0;  ///< of the merged maps [m]; 0 = the finest among the inputs
  /// Called with the number of finished and of expected comparisons (the latter may grow).
  std::function<void(std::size_t, std::size_t)> progress;
};

/// A comparison that was made between two groups of maps, said of one map of each: the first of its group.
struct Join {
  std::size_t fixed = 0;   ///< index of the input map
  std::size_t moving = 0;  ///< index of the input map
  MatchResult match;       ///< T_fixed_moving between the frames of these two input maps
};

struct Member {
  std::size_t map = 0;   ///< index of the input map
  SE2 T_component_map;   ///< takes the map's frame to the component's
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

/// Merges `maps` pairwise up a binary tree (Birk & Carpin 2006): (1 + 2), (3 + 4), then their results. Groups that are
/// refused stay apart and are tried again further up.
/// Throws std::invalid_argument for an invalid grid or option, naming the map by its index.
MergeResult merge(const std::vector<OccupancyGrid>& maps, const MergeOptions& options = {});

}  // namespace gridmerge
