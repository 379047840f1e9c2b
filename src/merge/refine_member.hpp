// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "gridmerge/match/match.hpp"
#include "internal_export.hpp"
#include "merge/log_odds.hpp"

namespace gridmerge::internal {

/// refine_pose() of a map on several others, fused where they lie. Poses take the maps' frames to one frame
/// that all have in common, and so does the result's T_fixed_moving. Of a single fixed map the figures are
/// those of the two maps themselves. Throws std::invalid_argument when there is no fixed map, for an invalid
/// map or a pose that is not finite, and when the fixed maps lie so far apart that their fusion would exceed
/// 2^26 cells. Runs in the calling TBB arena; time as fuse() and refine_pose().
GRIDMERGE_INTERNAL_EXPORT RefinedPose refine_member(const std::vector<PlacedMap>& fixed,
                                                    const PlacedMap& moving);

}  // namespace gridmerge::internal
