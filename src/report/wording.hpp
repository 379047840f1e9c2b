// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gridmerge/merge/merge_result.hpp"
#include "internal_export.hpp"

namespace gridmerge::internal {

/// Why one of `result.left_out` was left out of a merge, as the end of a sentence that begins with its name.
GRIDMERGE_INTERNAL_EXPORT const char* explain_left_out(const MergeResult& result, const LeftOut& one);

/// Why maps are not on the plan, as the end of a sentence that begins with their names.
GRIDMERGE_INTERNAL_EXPORT const char* explain_off_plan(Reason reason);

}  // namespace gridmerge::internal
