// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gridmerge/match/match_result.hpp"

namespace gridmerge::internal {

/// What it has that no match of two maps can have found, in words that begin with a verb; null if nothing.
const char* flaw_of(const PairPose& pose);

/// The same of a whole result. O(hypotheses).
const char* flaw_of(const MatchResult& match);

}  // namespace gridmerge::internal
