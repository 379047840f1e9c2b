// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "gridmerge/match/match.hpp"
#include "gridmerge/merge/merge.hpp"
#include "gridmerge/merge/merge_result.hpp"
#include "merge/consistent_set.hpp"

namespace gridmerge::internal {

/// A map of a merge with what is known of it.
struct MergeInput {
  std::size_t index;  ///< of the map in the result
  const OccupancyGrid* grid;
  const PreparedMap* prepared;
  std::optional<KnownPose> known_pose;
};

/// One merged map of the group: its poses adjusted to all that holds it together, in the world's frame if one
/// of them is fixed and in that of the member with the lowest index if not, and its maps fused. `inputs` are
/// the maps of the problem.
Component make_component(const NodeGroup& group, const JoinProblem& problem,
                         const ConsistentSet& consistent_set, const std::vector<MergeInput>& inputs,
                         const MergeOptions& options);

}  // namespace gridmerge::internal
