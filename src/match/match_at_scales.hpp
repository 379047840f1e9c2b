// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "gridmerge/match/match.hpp"
#include "internal_export.hpp"

namespace gridmerge::internal {

/// The scales at which a range is looked at: evenly spaced by their logarithms, 3 % apart at most, with both
/// ends.
std::vector<double> levels_of(const ScaleRange& scales);

/// match() at every scale of options.scales, which is given: every level is looked at as a pair by itself,
/// the best poses climb to the maximum over their scales too, and all of them are judged at their own scales
/// and are each other's rivals. The look is the quick one unless SearchMethod::thorough asks for the other.
/// Throws std::invalid_argument for a map without walls. Runs in the calling TBB arena. O(levels) times a
/// match.
GRIDMERGE_INTERNAL_EXPORT MatchResult match_at_scales(const PreparedMap& fixed, const PreparedMap& moving,
                                                      const MatchOptions& options);

}  // namespace gridmerge::internal
