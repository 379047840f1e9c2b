// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gridmerge/match/match_result.hpp"
#include "internal_export.hpp"

namespace gridmerge::internal {

/// Why a map lies with no other one, as the end of a sentence that begins with its name.
GRIDMERGE_INTERNAL_EXPORT const char* explain_left_out(Reason reason);

}  // namespace gridmerge::internal
