// SPDX-License-Identifier: Apache-2.0
#include "gridmerge/merge/merge_result.hpp"

namespace gridmerge {

const char* name_of(JoinOutcome outcome) {
  switch (outcome) {
    case JoinOutcome::accepted:
      return "accepted";
    case JoinOutcome::rescued:
      return "rescued";
    case JoinOutcome::rejected:
      return "rejected";
    case JoinOutcome::known:
      return "known";
    case JoinOutcome::refused:
      break;
  }
  return "refused";
}

}  // namespace gridmerge
