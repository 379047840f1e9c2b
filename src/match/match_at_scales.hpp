// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "gridmerge/match/match.hpp"
#include "internal_export.hpp"

namespace gridmerge::internal {

/// The scales at which a range is looked at: `unit`, and what differs from it by whole steps of 3 %, as far
/// as they are in the range or nearest to its ends. So a range about the answer finds what a wider one finds.
/// If one scale is nearest to both ends, it is the middle of the range.
std::vector<double> levels_of(const ScaleRange& scales, double unit);

/// match() at every scale of options.scales, which is given: every level is looked at as a pair by itself,
/// the best poses climb to the maximum over their scales too, and all of them are judged at their own scales
/// and are each other's rivals. The look is the quick one unless SearchMethod::thorough asks for the other.
/// Throws std::invalid_argument for a map without walls. Runs in the calling TBB arena. O(levels) times a
/// match.
GRIDMERGE_INTERNAL_EXPORT MatchResult match_at_scales(const PreparedMap& fixed, const PreparedMap& moving,
                                                      const MatchOptions& options);

}  // namespace gridmerge::internal
