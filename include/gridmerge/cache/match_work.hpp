// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "gridmerge/cache/match_cache.hpp"
#include "gridmerge/export.hpp"
#include "gridmerge/grid/occupancy_grid.hpp"
#include "gridmerge/merge/merger.hpp"

namespace gridmerge {

/// A part of the matches of a merge: of each round, in the order in which they are due, every `count`th.
struct Shard {
  std::size_t index = 0;  ///< which part, less than `count`
  std::size_t count = 1;  ///< how many parts there are
};

/// How match_with_cache() goes about it.
struct MatchWorkOptions {
  Shard shard;  ///< what is made; all, unless told otherwise
  /// When a match cannot be written, warns once and goes on; without it that is an error.
  bool goes_on_when_full = true;
  /// Called with the numbers of matches of a round that are there, and that are due; never from two threads
  /// at once.
  std::function<void(std::size_t, std::size_t)> progress;
};

/// What became of the matches that a merge needs.
struct MatchWork {
  std::size_t found = 0;  ///< in the cache
  std::size_t made = 0;   ///< here
  /// Of other shards, which have not made them yet: later rounds wait for them. 0 when all is matched.
  std::size_t missing = 0;
};

/// Hands the merger the matches that are due: those of the cache, and those of the shard that it makes and
/// keeps there. Round by round, until nothing is due or the rest is for others to make. `maps` are those that
/// were added, in the order of Merger::maps(). Threads as the merger's; may be cancelled, and then goes on
/// where it was. Throws FileError, std::invalid_argument for a shard that there is not or another number of
/// maps, and Cancelled.
GRIDMERGE_EXPORT MatchWork match_with_cache(Merger& merger, const std::vector<OccupancyGrid>& maps,
                                            MatchCache& cache, const MatchWorkOptions& options = {});

}  // namespace gridmerge
