// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "gridmerge/match/match.hpp"
#include "gridmerge/match/measure.hpp"
#include "internal_export.hpp"

namespace gridmerge::internal {

// Lines for programs to read. Keys come in the order in which the documentation lists them, numbers in the
// shortest form that reads back to the same bits. Names are given by the caller and may hold any bytes: what
// is not UTF-8 appears as U+FFFD. A number that is not finite (no result of the library holds one) throws
// std::invalid_argument, since JSON cannot say it.

/// What `gridmerge match --json` prints: one line, with its end. `with_scale` adds the scales of the result
/// and of its hypotheses, which are 1 unless a match looked for them (MatchOptions::scales).
GRIDMERGE_INTERNAL_EXPORT std::string match_json(const std::string& fixed, const std::string& moving,
                                                 const MatchResult& result, bool with_scale = false);

/// What `gridmerge measure --json` prints: one line, with its end. For one moving map its measures, for
/// several omega of all and the measures of each on the fixed one. `moving[i]` is what to call moving map i.
/// Throws std::out_of_range when there are fewer names than maps.
GRIDMERGE_INTERNAL_EXPORT std::string measure_json(const std::string& fixed,
                                                   const std::vector<std::string>& moving,
                                                   const JointMeasure& measure, double c_lock);

}  // namespace gridmerge::internal
