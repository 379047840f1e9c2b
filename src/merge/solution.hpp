// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <set>
#include <vector>

#include "gridmerge/merge/merge.hpp"
#include "gridmerge/merge/merge_result.hpp"
#include "merge/consistent_set.hpp"
#include "merge/copies.hpp"
#include "merge/map_store.hpp"
#include "merge/pair_looks.hpp"

namespace gridmerge::internal {

/// Which maps lie together, and what was said of them.
struct Solution {
  JoinProblem problem;  ///< of the maps that count
  ConsistentSet consistent_set;
  std::set<PairLooks::Pair>
      again;  ///< pairs of which the second look counts: the lower id and the higher one
};

/// What the pairs that were chosen say of these maps, with what is known of their poses.
JoinProblem make_problem(const MapStore& store, const std::vector<MapStore::MapId>& maps,
                         const std::vector<PairLooks::Pair>& chosen, const PairLooks& looks,
                         const std::set<PairLooks::Pair>& again);

/// Those of the chosen pairs whose maps lie in no common group. `maps` are those of the consistent set.
std::vector<PairLooks::Pair> pairs_apart(const std::vector<PairLooks::Pair>& chosen,
                                         const std::vector<MapStore::MapId>& maps,
                                         const ConsistentSet& consistent_set);

/// Most members first.
void sort_components(MergeResult& result);

/// What a solution means for all maps, with the copies that it does without. Runs in the calling TBB arena.
MergeResult make_result(const MapStore& store, const std::vector<MapStore::MapId>& maps,
                        const std::vector<Copy>& copies, const PairLooks& looks, const Solution& solution,
                        const MergeOptions& options);

}  // namespace gridmerge::internal
