// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "gridmerge/match/prepared_map.hpp"
#include "gridmerge/merge/arrangement.hpp"
#include "gridmerge/merge/known_pose.hpp"
#include "gridmerge/merge/merge_result.hpp"

namespace gridmerge {

/// One merged map of the group: its poses adjusted to all that holds it together, in the frame that is asked
/// for, and its maps fused.
Component make_component(const NodeGroup& group, const ArrangementProblem& problem,
                         const Arrangement& arrangement, const std::vector<const OccupancyGrid*>& grids,
                         const std::vector<const PreparedMap*>& prepared,
                         const std::vector<std::optional<KnownPose>>& known_poses, double resolution);

}  // namespace gridmerge
