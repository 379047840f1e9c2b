// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gridmerge/match/match.hpp"
#include "gridmerge/match/match_result.hpp"
#include "internal_export.hpp"
#include "similarity/agreement.hpp"

namespace gridmerge::internal {

/// Says of the pose what two maps have in common there, by what was counted on cells of `moving`.
/// O(cells of both).
void set_common(const AgreementCounts& counts, const OccupancyGrid& fixed, const OccupancyGrid& moving,
                PairPose& pose);

/// The same, counted where `pose` lays `moving`.
void count_common(const OccupancyGrid& fixed, const OccupancyGrid& moving, PairPose& pose);

/// The same on cells of the smaller map, so that it does not depend on which one is called fixed.
GRIDMERGE_INTERNAL_EXPORT void count_common(const PreparedMap& fixed, const PreparedMap& moving,
                                            PairPose& pose);

}  // namespace gridmerge::internal
