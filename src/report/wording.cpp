// SPDX-License-Identifier: Apache-2.0
#include "report/wording.hpp"

namespace gridmerge::internal {

const char* explain_left_out(const MergeResult& result, std::size_t index) {
  switch (result.left_out_reasons.at(index)) {
    case Reason::nothing_to_compare: {
      const bool alone = result.components.empty() && result.left_out.size() == 1;
      return alone ? "there is no other map to merge it with" : "there is too little in it to compare";
    }
    case Reason::ambiguous:
      return "it fits in more than one way";
    case Reason::contradiction:
      return "it disagrees with the others where both know the same places";
    case Reason::too_little_overlap:
      return "it shares too little with the others";
    case Reason::contradicts_others:
      return "what speaks for it contradicts the other maps";
    case Reason::several:
    case Reason::none:
      break;
  }
  return "nothing speaks for it clearly enough";
}

}  // namespace gridmerge::internal
