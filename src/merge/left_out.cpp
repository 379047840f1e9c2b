// SPDX-License-Identifier: Apache-2.0
#include "merge/left_out.hpp"

namespace gridmerge::internal {

const char* explain_left_out(Reason reason) {
  switch (reason) {
    case Reason::nothing_to_compare:
      return "there is too little in it, or in the others, to compare";
    case Reason::ambiguous:
      return "it fits in more than one way";
    case Reason::contradiction:
      return "it disagrees with the others where both know the same places";
    case Reason::too_little_overlap:
      return "it shares too little with the others";
    case Reason::contradicts_others:
      return "what speaks for it contradicts the other maps";
    case Reason::over_budget:
      return "its joins are too doubtful for the budget of false joins";
    case Reason::several:
    case Reason::none:
      break;
  }
  return "nothing speaks for it clearly enough";
}

}  // namespace gridmerge::internal
