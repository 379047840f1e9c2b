// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gridmerge/match/match_result.hpp"
#include "internal_export.hpp"

namespace gridmerge::internal {

/// Why a map lies with no other one: what goes behind its name and a colon.
GRIDMERGE_INTERNAL_EXPORT const char* explain_left_out(Reason reason);

}  // namespace gridmerge::internal
