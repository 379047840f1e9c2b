// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "merge/join_weights.hpp"

namespace gridmerge::internal {

/// Groups of maps that are cut in two where their parts belong together least surely. Each cut takes evidence
/// from what is left, so after each one it is found out anew what is least sure. Runs in the calling TBB
/// arena. `weights` must outlive this.
class GroupCuts {
 public:
  /// Cuts apart what nothing holds together, and nothing else.
  GroupCuts(const JoinWeights& weights, const NodeGroups& groups);

  NodeGroups groups() const;

  /// Each in the frame of its lowest map, maps ascending, and the groups by their first maps; with how surely
  /// each member lies as it does, given the others. For a group of n maps that is new since, n joins are
  /// weighed.
  NodeGroups weighed_groups();

  /// Cuts as long as some parts belong together less surely than so. For a group of n maps, each cut weighs
  /// less than 2 n others.
  void cut_below(double keep_probability);

  /// Makes the least sure cut of all; false if there is none.
  bool cut_least();

 private:
  struct Cut {
    double probability;  ///< that the halves lie so, and belong together
    std::pair<NodeGroup, NodeGroup> halves;
  };
  struct Part {
    NodeGroup group;
    std::optional<Cut> least;          ///< none of a single map, or of maps that are all fixed
    std::optional<NodeGroup> weighed;  ///< none before anybody asked
  };

  void add(NodeGroup group);
  void find_least_from(std::size_t first);
  std::optional<Cut> least_cut_of(const NodeGroup& group) const;
  void cut(const std::vector<std::size_t>& places);

  const JoinWeights& weights_;
  std::vector<Part> parts_;
};

}  // namespace gridmerge::internal
