// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "merge/disjoint_sets.hpp"
#include "merge/pair_candidates.hpp"

namespace gridmerge::internal {

using NodeGroups = std::vector<NodeGroup>;

/// What it is worth that a pose which others chose is among a pair's candidates, beyond what the pair itself
/// thinks of it: the dozen candidates of an unrelated pair are spread over thousands of square metres and a
/// turn, but walls are parallel nearly everywhere, so that about one in 150 agrees by chance.
inline constexpr double kPoseNats = 5.0;

/// The log odds of a candidate that says nothing: worth nothing, and no loss.
inline constexpr double kSaysNothing = -kPoseNats;

/// Maps that are not of one place may be of two places that look alike. There their pairs agree as well, and
/// only what each pair says by itself tells the two from one. So much likelier one place is beforehand
/// [nats].
inline constexpr double kAlikeNats = 0.5;

/// What it says against a pose if two maps that have such a share of the smaller one in common there have no
/// candidate that agrees [nats].
double nats_of_a_miss(double share_in_common);

/// What it is worth to two groups of maps to lie together so [nats].
struct JoinWorth {
  double against_other_poses = 0.0;  ///< all that speaks for it: tells how they lie, if they belong together
  /// What speaks for their belonging together, once for every place: against being unrelated, and against
  /// being of places that look alike.
  double against_apart = 0.0;
};

/// A way to join two groups of maps.
struct WeighedJoin {
  SE2 T_a_b;  ///< between the groups' frames
  JoinWorth worth;
  double probability = 0.0;  ///< against lying otherwise, and apart
};

/// What the candidates of all pairs say of groups of maps: see find_consistent_set() for what a consistent
/// set is worth.
class JoinWeights {
 public:
  /// `problem` must outlive this. O(maps + pairs).
  explicit JoinWeights(const JoinProblem& problem);

  std::size_t maps() const { return problem_.maps.size(); }

  /// The other maps of the pairs of a map that have candidates, ascending.
  std::vector<std::size_t> partners_of(std::size_t map) const;

  /// Whether the map's pose is the truth, whatever pairs say.
  bool is_fixed(std::size_t map) const { return problem_.maps[map].T_world_map.has_value(); }

  /// The ways to join two groups that some candidate proposes, most is said for the first.
  std::vector<WeighedJoin> ways_to_join(const NodeGroup& a, const NodeGroup& b) const;

  /// The same in no order, and with two single maps weighed as groups are: by what their candidate says
  /// alone.
  std::vector<WeighedJoin> ways_by_worth(const NodeGroup& a, const NodeGroup& b) const;

  /// The first of them; none if no candidate proposes any. Of groups of more than one map also none, soon, if
  /// no way can be worth more than `least` against being apart [nats].
  std::optional<WeighedJoin> best_join(const NodeGroup& a, const NodeGroup& b, double least = kAny) const;

  /// The same without its probability, in a fraction of the time, and with two single maps weighed as groups
  /// are: what a map gains there can be compared with what worth_of() says that it loses here.
  std::optional<WeighedJoin> best_way(const NodeGroup& a, const NodeGroup& b, double least = kAny) const;

  /// What it is worth that the groups lie so.
  JoinWorth worth_of(const NodeGroup& a, const NodeGroup& b, const SE2& T_a_b) const;

  /// That two groups in one frame lie as they do: against the other ways that candidates propose, and apart.
  double probability_of_lying_so(const NodeGroup& a, const NodeGroup& b) const;

  /// The candidates that agree with the poses of a group.
  std::vector<UsedCandidate> used_in(const NodeGroup& group) const;

  /// The parts of a group that candidates which agree with its poses, or being fixed, hold together.
  NodeGroups connected(const NodeGroup& group) const;

  /// The ways to cut a group in two that are worth a look: along the strongest candidates that hold it
  /// together, one for each edge of their maximum spanning tree, and each map that is not fixed from the
  /// rest, as its probability is told. O(edges + maps^2).
  std::vector<std::pair<NodeGroup, NodeGroup>> halves(const NodeGroup& group) const;

  /// The group with the poses that fit its candidates best; fixed ones are as they were.
  NodeGroup adjusted(NodeGroup group) const;

 private:
  static constexpr double kAny = -std::numeric_limits<double>::infinity();

  struct Agreement {
    std::size_t pair;
    std::size_t candidate;
    double worth;
  };

  /// A candidate made ready for finding out, many times, whether poses agree with it.
  struct Mark {
    Point2 moving_centre;  // in the fixed frame
    Point2 fixed_centre;   // in the moving frame
    double cos, sin;
  };
  static Mark mark_of(const ManyPointsTransform& T_fixed_moving, const MapExtent& fixed,
                      const MapExtent& moving);

  struct Edge {
    std::size_t a, b;  // places in the group
    Agreement agreement;
  };

  /// A pair of a map: the other one, and its index in the problem.
  struct Partner {
    std::size_t map;
    std::size_t pair;
  };

  /// A pose between two groups that a candidate proposes.
  struct Proposal {
    SE2 T_a_b;
    double agreement = 0.0;   // of all pairs across the groups, for and against [nats]
    double most_worth = 0.0;  // against other poses: it is not worth more [nats]
  };

  /// A pair with candidates across two groups: places in them, and its index in the problem.
  struct Across {
    std::size_t a, b, pair;
  };

  std::optional<std::size_t> pair_of(std::size_t a, std::size_t b) const;
  /// T takes points of map b to map a.
  std::optional<Agreement> find_agreement(std::size_t pair, std::size_t a,
                                          const ManyPointsTransform& T_a_b) const;
  /// In the order of the places. O(maps + pairs of the smaller group's maps).
  std::vector<Across> pairs_across(const NodeGroup& a, const NodeGroup& b) const;
  static std::vector<ManyPointsTransform> poses_of(const NodeGroup& group);
  void unite_fixed(const NodeGroup& group, DisjointSets& places) const;
  std::vector<WeighedJoin> ways_of_pair(const PlacedNode& a, const PlacedNode& b) const;
  /// The distinct ways that candidates propose, without their probabilities. A way that is worth less than
  /// the best one by more than `margin` may be missing; all are, if none can be worth more than `least`
  /// against being apart.
  std::vector<WeighedJoin> weigh_proposals(const NodeGroup& a, const NodeGroup& b, double margin,
                                           double least) const;
  std::vector<Proposal> proposals(const NodeGroup& a, const NodeGroup& b) const;
  std::vector<Edge> edges_of(const NodeGroup& group) const;

  const JoinProblem& problem_;
  std::vector<std::vector<Mark>> marks_;        // by pair, one a candidate
  std::vector<std::vector<Partner>> partners_;  // by map, ascending
};

/// How probable each of several ways is against the others, and against being apart, which is worth 0.
/// O(ways).
void weigh_against_each_other(std::vector<WeighedJoin>& ways);

/// A group without one of its maps, and that map, both in the group's frame.
std::pair<NodeGroup, NodeGroup> taken_out(const NodeGroup& group, std::size_t place);

}  // namespace gridmerge::internal
