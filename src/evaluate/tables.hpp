// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "gridmerge/evaluate/evaluate.hpp"
#include "internal_export.hpp"

namespace gridmerge::internal {

/// For people: counts (by tier where there are tiers), times, and what other acceptance thresholds would do;
/// the row of `accept_probability` is marked. Several lines, each ending in a newline.
GRIDMERGE_INTERNAL_EXPORT std::string summary_table(const Evaluation& evaluation, double accept_probability);

/// For people: a line for each match. Ends in a newline unless there is none.
GRIDMERGE_INTERNAL_EXPORT std::string case_table(const Evaluation& evaluation);

/// For fitting the verdict's model: tab-separated, a line for each match that has a hypothesis, in file
/// order. Columns: fixed, moving, truth (`right` or `wrong` best hypothesis of a true pair, `negative`),
/// tier, probability, reason, and the VerdictFeatures by name. Numbers read back to the same bits.
GRIDMERGE_INTERNAL_EXPORT std::string features_table(const Evaluation& evaluation);

/// For programs: a JSON object with the keys `pairs`, `negatives`, `sets`, `seconds` and `cases`, always all
/// of them. `cases` lists the pairs, then the negatives, in file order; a negative has no truth, so its
/// `error`, `tolerance` and `correct` are null. Ends in a newline.
GRIDMERGE_INTERNAL_EXPORT std::string evaluation_json(const Evaluation& evaluation);

}  // namespace gridmerge::internal
