// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gridmerge/match/match.hpp"

namespace gridmerge {

/// The verdict's one word in every output.
inline const char* name_of(Verdict verdict) {
  return verdict == Verdict::accepted ? "accepted" : "refused";
}

}  // namespace gridmerge
