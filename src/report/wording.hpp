// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "gridmerge/merge/merge_result.hpp"
#include "internal_export.hpp"

namespace gridmerge::internal {

/// Why `result.left_out[index]` was left out of a merge, as the end of a sentence that begins with its name.
/// Throws std::out_of_range when there are fewer reasons.
GRIDMERGE_INTERNAL_EXPORT const char* explain_left_out(const MergeResult& result, std::size_t index);

}  // namespace gridmerge::internal
