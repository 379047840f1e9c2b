// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gridmerge/match/verdict.hpp"

namespace gridmerge {

/// Why a map was left out of a merge, as the end of a sentence that begins with its name.
const char* explain_left_out(Reason reason);

}  // namespace gridmerge
