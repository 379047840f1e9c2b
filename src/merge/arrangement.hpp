// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "gridmerge/grid/se2.hpp"
#include "internal_export.hpp"
#include "merge/coverage.hpp"

namespace gridmerge::internal {

/// One way in which two maps may lie, from what they say of each other alone.
struct CandidateJoin {
  SE2 T_fixed_moving;     ///< between the map frames
  double log_odds = 0.0;  ///< of being true, from these two maps alone [nats]
  double sd = 1.0;        ///< if it is true: standard deviation of the displacement from the true pose [m]
  bool is_known = false;  ///< it is not what the maps say, but what is known of their poses beforehand
};

/// The candidates of two maps.
struct PairCandidates {
  std::size_t fixed = 0;  ///< index of the map, less than `moving`
  std::size_t moving = 0;
  std::vector<CandidateJoin> candidates;  ///< distinct; none if nothing speaks for the pair
};

/// All that is known of k maps.
struct ArrangementProblem {
  std::vector<MapExtent> maps;
  std::vector<PairCandidates> pairs;  ///< at most one a pair of maps
  /// Where each map knows anything; without it no two maps are thought to have anything in common, and every
  /// pair is thought to speak of other places than the rest.
  std::vector<const Coverage*> coverage;
  /// Poses in one frame that are the truth, whatever pairs say; may be shorter than `maps`.
  std::vector<std::optional<SE2>> fixed;
};

struct PlacedNode {
  std::size_t map = 0;
  SE2 T_group_map;
  double probability = 1.0;  ///< that the map lies there, given where the others of the group lie
};

/// Maps that lie together. The frame is that of the first.
using NodeGroup = std::vector<PlacedNode>;

/// A candidate that the arrangement agrees with.
struct UsedCandidate {
  std::size_t pair = 0;       ///< index into ArrangementProblem::pairs
  std::size_t candidate = 0;  ///< index into its candidates
};

struct Arrangement {
  std::vector<NodeGroup> groups;    ///< every map is in one; ascending by first map, maps ascending
  std::vector<UsedCandidate> used;  ///< ascending by pair, at most one a pair
};

/// A way to join two groups that was not taken, though it may be the true one.
struct OpenJoin {
  std::size_t a = 0;  ///< index into Arrangement::groups, less than `b`
  std::size_t b = 0;
  SE2 T_a_b;                 ///< between the groups' frames
  double probability = 0.0;  ///< against lying otherwise, and apart
};

/// How far apart a pair's candidate and the poses of an arrangement may put the maps and still agree [m]:
/// bent maps do not close a cycle exactly.
GRIDMERGE_INTERNAL_EXPORT double agreement_tolerance(const MapExtent& a, const MapExtent& b);

/// Root mean square distance by which two poses of a map of this extent differ [m].
GRIDMERGE_INTERNAL_EXPORT double displacement(const MapExtent& moving, const SE2& a, const SE2& b);

/// How far two ways in which maps a and b may lie differ [m]: the displacement of that map which it moves
/// less. The same whichever of the two is taken for the moving one.
GRIDMERGE_INTERNAL_EXPORT double difference(const MapExtent& a, const MapExtent& b, const SE2& T_a_b,
                                            const SE2& T_a_b_other);

/// The arrangement of all maps that the candidates speak for most, as far as it can be believed.
///
/// To lie together so is worth to two groups of maps what the pairs across them say of it: the log odds of a
/// candidate that agrees, and what it is worth that a pose which others chose is among the pair's few
/// candidates; or, when none agrees, a loss that grows with how much the two maps would have in common. Less
/// what choosing the pose is worth, once. So two maps alone are worth the log odds of their candidate, and in
/// a cycle that closes every further pair adds. But pairs do not err independently: maps that look alike in
/// one place agree with each other there, however many they are. So a pair counts by how much of what its
/// maps have in common no stronger pair has spoken of; the rest counts less, and not at all where it is asked
/// whether the groups belong together, rather than how they lie.
///
/// Starting from single maps, and one group of those that are fixed, the two groups that are worth most
/// together are joined, as long as that is probable enough (`accept_probability`): against lying otherwise,
/// and against not belonging together. Then every map is taken out and put where it is worth most, which
/// takes back what was joined too early, until nothing changes. At last a group is cut where its two parts
/// could not be joined as surely as asked for. Fixed maps are neither moved nor cut apart.
///
/// Deterministic; the order of maps and pairs plays no part beyond rounding, and which map a group's frame is
/// that of. Runs in the calling TBB arena. O(k^2) joins are weighed a round, k rounds; a join of groups of a
/// and b maps with c candidates a pair is weighed in O((a b c)^2), but only 50 poses of it in full. Throws
/// std::invalid_argument for indices, numbers of maps or a probability that make no sense.
Arrangement arrange(const ArrangementProblem& problem, double accept_probability);

/// The ways to join two groups of an arrangement of the problem that have at least this probability, most
/// probable first: rivals among which nothing decides, and ways that are not sure enough. Runs in the calling
/// TBB arena. O(groups^2) joins are weighed, as in a round of arrange(). Throws std::invalid_argument as
/// arrange().
std::vector<OpenJoin> find_open_joins(const ArrangementProblem& problem, const Arrangement& arrangement,
                                      double least_probability);

/// How many joins of an arrangement are expected to be false: of each group of n maps, n - 1 times the mean
/// doubt in a member that is not fixed. O(maps).
double expected_false_joins(const Arrangement& arrangement);

/// arrange() with as many joins as a budget of false ones allows: as long as more are expected, the groups
/// are cut from a higher probability on, that of the least sure member. Joined are they from
/// `accept_probability` on: what two maps alone say is seldom as sure as what many say in the end. O(joins)
/// times arrange(). Throws std::invalid_argument as arrange(), and for a budget that is negative or not
/// finite.
Arrangement arrange_within(const ArrangementProblem& problem, double accept_probability,
                           double max_false_joins);

}  // namespace gridmerge::internal
