// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "gridmerge/match/match.hpp"
#include "merge/pair_candidates.hpp"

namespace gridmerge::internal {

/// How many hypotheses of a pair are kept for the consistent set.
inline constexpr std::size_t kKeptHypotheses = 12;

/// Hypotheses that are less likely than this are no candidates.
inline constexpr double kMinCandidateProbability = 1e-3;

/// A pose is off by about so many standard deviations of the walls that agree on it: bent maps have no exact
/// one.
inline constexpr double kDeviationsOfWalls = 2.0;

/// The hypotheses of a match, with the odds that their probabilities give them, in their order. Those that
/// are less likely than kMinCandidateProbability are left out.
std::vector<CandidateJoin> candidate_joins(const MatchResult& match);

}  // namespace gridmerge::internal
