// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "gridmerge/grid/occupancy_grid.hpp"
#include "gridmerge/match/match.hpp"
#include "internal_export.hpp"

namespace gridmerge::internal {

/// A factor between the scales of two maps.
struct ScaleFound {
  double factor = 1.0;       ///< by which the moving map's resolution is too small
  double probability = 0.0;  ///< of the match at that scale
};

/// For two maps that do not fit: whether they do when the moving map's resolution is multiplied by one of the
/// ratios of usual resolutions (2, 2.5, 4, 5 or 10, or the inverse), and by which most surely. So many
/// attempts find a chance match more often than one, so a probability of 0.99 is asked for, and the answer is
/// a hint for people, no verdict. Ten times the time of match() at most. Throws as match().
GRIDMERGE_INTERNAL_EXPORT std::optional<ScaleFound> find_scale(const OccupancyGrid& fixed,
                                                               const OccupancyGrid& moving,
                                                               const MatchOptions& options = {});

}  // namespace gridmerge::internal
