// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "internal_export.hpp"
#include "merge/pair_candidates.hpp"

namespace gridmerge::internal {

struct ConsistentSet {
  std::vector<NodeGroup> groups;    ///< every map is in one; ascending by first map, maps ascending
  std::vector<UsedCandidate> used;  ///< ascending by pair, at most one per pair
  /// Pairs that a larger budget of false joins would use, ascending.
  std::vector<std::size_t> over_budget = {};
};

/// A way to join two groups that was not taken, though it may be the true one.
struct OpenJoin {
  std::size_t a = 0;  ///< index into ConsistentSet::groups, less than `b`
  std::size_t b = 0;
  SE2 T_a_b;                 ///< between the groups' frames
  double probability = 0.0;  ///< against lying otherwise, and apart
};

/// The consistent set of all maps that the candidates speak for most, as far as it can be believed.
///
/// To lie together so is worth to two groups of maps what the pairs across them say of it: the log odds of a
/// candidate that agrees, and what it is worth that a pose which others chose is among the pair's few
/// candidates; or, when none agrees, a loss that grows with how much the two maps would have in common. Less
/// what choosing the pose is worth, once. So two maps alone are worth the log odds of their candidate, and in
/// a cycle that closes every further pair adds. But pairs do not err independently: maps that look alike in
/// one place agree with each other there, however many they are. So a pair counts by how much of what its
/// maps have in common no stronger pair has spoken of; the rest counts less, and not at all where it is asked
/// whether the groups belong together, rather than how they lie. And of three or more maps there is a third
/// case beside one place and no relation: two places that look alike. There poses agree as well, so that only
/// what each pair says by itself counts against it, and a pair that doubts counts for it.
///
/// Starting from single maps, and one group of those that are fixed, the two groups that are worth most
/// together are joined, as long as that is probable enough (`accept_probability`): against lying otherwise,
/// and against not belonging together. Then every map is taken out and put where it is worth most, which
/// takes back what was joined too early, until nothing gains or has moves left. At last a group is cut where
/// its two parts could not be joined as surely as asked for. Fixed maps are neither moved nor cut apart.
///
/// Deterministic; the order of maps and pairs plays no part beyond rounding, and which map a group's frame is
/// that of. Runs in the calling TBB arena. Only groups between which a pair has a candidate are weighed,
/// and again when one of them changes: see GroupSearch. A join of groups across which p pairs have c
/// candidates each is weighed in O((p c)^2), but only 50 poses of it in full. Throws std::invalid_argument
/// for indices or a probability that make no sense.
ConsistentSet find_consistent_set(const JoinProblem& problem, double accept_probability);

/// The ways to join two groups of a consistent set of the problem that have at least this probability, most
/// probable first: rivals among which nothing decides, and ways that are not sure enough. Runs in the calling
/// TBB arena. One join is weighed for each two groups between which a pair has a candidate. Throws
/// std::invalid_argument as find_consistent_set().
std::vector<OpenJoin> find_open_joins(const JoinProblem& problem, const ConsistentSet& consistent_set,
                                      double least_probability);

/// How many joins of a consistent set are expected to be false: of each group of n maps, n - 1 times the mean
/// doubt in a member that is not fixed. O(maps).
double expected_false_joins(const ConsistentSet& consistent_set);

/// Of up to so many maps all pairs are looked at, and a budget of false joins holds for all of them.
inline constexpr std::size_t kFewMaps = 50;

/// So many joins of a merge of so many maps may be expected to be false, by MergeOptions::max_false_joins.
/// Many maps are many teams, and each has the budget of one: or what is surely one map would be cut for maps
/// that have nothing to do with it. Throws std::invalid_argument for a budget that is negative or not finite.
GRIDMERGE_INTERNAL_EXPORT double false_joins_allowed(double max_false_joins, std::size_t maps);

/// find_consistent_set() with no more joins than a budget of false ones allows. While more are expected, the
/// least sure cut of all groups is made, and no other: where many members are as sure as each other, a limit
/// for all of them would cut all or none. What a cut makes surer afterwards is not joined again. A smaller
/// budget only cuts further. O(maps) cuts at most, each as find_consistent_set() makes them.
/// Throws std::invalid_argument as find_consistent_set(), and for a budget that is negative or not finite.
ConsistentSet find_consistent_set_within(const JoinProblem& problem, double accept_probability,
                                         double max_false_joins);

}  // namespace gridmerge::internal
