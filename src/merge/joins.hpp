// SPDX-License-Identifier: Apache-2.0
// What the ways to merge have in common.
#pragma once

#include <vector>

#include "gridmerge/merge/arrangement.hpp"
#include "gridmerge/merge/merge_result.hpp"

namespace gridmerge {

/// Throws std::invalid_argument for an invalid map, naming it by its index, or an invalid resolution of the
/// merged maps.
void validate_merge(const std::vector<OccupancyGrid>& maps, double resolution);

/// A join that means what its own verdict says.
Join make_join(std::size_t fixed, std::size_t moving, MatchResult match);

/// The same when other maps had a say: `used` is the candidate that the arrangement agrees with, or null.
Join make_join(std::size_t fixed, std::size_t moving, MatchResult match, const CandidateJoin* used);

/// The same with the other map as the fixed one.
MatchResult inverted(MatchResult match);
Join inverted(Join join);

/// Why a map joined nothing: the reason of the refused join of it that was most probable.
Reason why_left_out(const std::vector<Join>& joins, std::size_t map);

}  // namespace gridmerge
