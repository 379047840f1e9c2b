// SPDX-License-Identifier: Apache-2.0
// What pairs say of how maps lie together, and maps that are thought to lie so.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "gridmerge/grid/se2.hpp"
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

/// What is known of one map by itself.
struct ProblemMap {
  MapExtent extent;
  /// Where it knows anything. Without it the map is thought to have nothing in common with others, and each
  /// of its pairs is thought to speak of other places than the rest.
  const Coverage* coverage = nullptr;
  std::optional<SE2> T_world_map = std::nullopt;  ///< if that is the truth, whatever pairs say
};

/// All that is known of k maps.
struct JoinProblem {
  std::vector<ProblemMap> maps;
  std::vector<PairCandidates> pairs;  ///< at most one per pair of maps
  /// All maps lie on the first one, and what pairs say knows how often it fits by chance.
  bool is_of_a_plan = false;

  /// Maps may be of places that look alike, of which no pair can know: not two by themselves, which lie as
  /// surely as their pair says.
  bool may_look_alike() const { return maps.size() > 2 && !is_of_a_plan; }
};

struct PlacedNode {
  std::size_t map = 0;
  SE2 T_group_map;
  double probability = 1.0;  ///< that the map lies there, given where the others of the group lie
};

/// Maps that lie together. The frame is that of the first.
using NodeGroup = std::vector<PlacedNode>;

/// A candidate that the consistent set agrees with.
struct UsedCandidate {
  std::size_t pair = 0;       ///< index into JoinProblem::pairs
  std::size_t candidate = 0;  ///< index into its candidates
};

}  // namespace gridmerge::internal
