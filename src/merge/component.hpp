// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "gridmerge/match/prepared_map.hpp"
#include "gridmerge/merge/known_pose.hpp"
#include "gridmerge/merge/merge.hpp"
#include "gridmerge/merge/merge_result.hpp"
#include "merge/consistent_set.hpp"

namespace gridmerge::internal {

/// All maps of a merge in one order, whatever is known of each.
struct MergeInputs {
  std::vector<const OccupancyGrid*> grids;
  std::vector<const PreparedMap*> prepared;
  std::vector<std::optional<KnownPose>> known_poses;
  std::vector<std::size_t> index;  ///< of the map in the result
};

/// One merged map of the group: its poses adjusted to all that holds it together, in the world's frame if one
/// of them is fixed and in that of the member with the lowest index if not, and its maps fused.
Component make_component(const NodeGroup& group, const JoinProblem& problem,
                         const ConsistentSet& consistent_set, const MergeInputs& inputs,
                         const MergeOptions& options);

}  // namespace gridmerge::internal
