// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "merge/join_weights.hpp"

namespace gridmerge::internal {

/// All maps in groups, joined and moved about until none gains or has moves left: find_consistent_set() says
/// how. Maps that no chain of candidates connects have nothing to do with each other, so each connected part
/// of the maps is arranged by itself; and of two groups only those are weighed between which a pair has a
/// candidate.
class GroupSearch {
 public:
  /// Groups are joined from `accept_probability` on. Both must outlive this. Runs in the calling TBB arena.
  /// O(joins * (log(joins) + pairs of a group)) joins are weighed; a group of n maps is adjusted n times.
  GroupSearch(const JoinWeights& weights, const JoinProblem& problem, double accept_probability);

  NodeGroups groups() const;

 private:
  std::vector<NodeGroups> parts_;  // groups of each connected part
};

}  // namespace gridmerge::internal
