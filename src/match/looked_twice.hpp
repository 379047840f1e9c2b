// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "gridmerge/match/match.hpp"
#include "internal_export.hpp"

namespace gridmerge::internal {

/// All that the quick look at two maps finds, as match() compares them, whichever is called fixed.
using QuickLook = std::vector<Hypothesis>;

/// match() by the quick search, and what it has found.
struct QuickMatch {
  MatchResult result;
  QuickLook found;
};
GRIDMERGE_INTERNAL_EXPORT QuickMatch match_quickly(const PreparedMap& fixed, const PreparedMap& moving,
                                                   MatchOptions options);

/// match() by the exhaustive search, without the quick look that it begins with: `found` is that of the same
/// maps. The same bits.
GRIDMERGE_INTERNAL_EXPORT MatchResult match_again(const PreparedMap& fixed, const PreparedMap& moving,
                                                  MatchOptions options, const QuickLook& found);

/// match() by the exhaustive search, which ends after the quick look if its best pose is less probable than
/// this.
GRIDMERGE_INTERNAL_EXPORT MatchResult match_if_promising(const PreparedMap& fixed, const PreparedMap& moving,
                                                         const MatchOptions& options, double promising_from);

}  // namespace gridmerge::internal
