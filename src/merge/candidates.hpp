// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "gridmerge/match/match.hpp"
#include "gridmerge/merge/arrangement.hpp"

namespace gridmerge {

/// How many hypotheses of a pair are kept for the arrangement.
inline constexpr std::size_t kKeptHypotheses = 12;

/// The hypotheses of a match of two of `maps` maps, with their odds. Those that the match calls less likely
/// than one in a thousand are left out.
///
/// A match gives the odds of two maps by themselves. Among three or more most pairs share little or nothing,
/// and the surest of many matches is too often of a place that looks the same: their odds are less.
std::vector<CandidateJoin> candidate_joins(const MatchResult& match, std::size_t maps);

}  // namespace gridmerge
