// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "gridmerge/merge/merge_result.hpp"

namespace gridmerge::internal {

/// So many comparisons are told in full: all pairs of 50 maps.
inline constexpr std::size_t kMostToldInFull = 1225;
/// So many of the other refused ones have a row in a table.
inline constexpr std::size_t kMostRows = 5000;

/// What outputs tell of the comparisons of a merge: all of few maps, and what matters of many. A thousand
/// maps have half a million pairs, of which nearly all are refused.
struct ToldJoins {
  bool in_full = true;
  /// Indexes of joins, ascending: with all figures. Of many: the used and the rejected ones, and those of
  /// which an open way tells.
  std::vector<std::size_t> objects;
  /// Indexes of joins, ascending: the most probable of the others, 0.01 or more. None if all are told.
  std::vector<std::size_t> rows;
  /// All that are no objects, counted: by reason, in the order of Reason, none of zero.
  std::vector<RefusedCount> counts;
};

/// O(joins log joins).
ToldJoins tell_joins(const MergeResult& result);

/// The hypotheses of a join that outputs tell, in their order. All of one that was used or contradicts the
/// others, if joins are told in full. Else the best, those that may well be true, and the one that was used.
std::vector<Hypothesis> told_hypotheses(const Join& join, bool in_full);

/// The standard deviation by which the merge weighed a join [m], if it is known: the pose is then one of the
/// maps' own hypotheses.
std::optional<double> deviation_of(const Join& join);

/// Takes a deviation back, as deviation_of() gives it.
void set_deviation(Join& join, double sd);

}  // namespace gridmerge::internal
