// SPDX-License-Identifier: Apache-2.0
#include "report/wording.hpp"

#include "merge/left_out.hpp"

namespace gridmerge::internal {

const char* explain_left_out(const MergeResult& result, const LeftOut& one) {
  const bool alone = result.components.empty() && result.left_out.size() == 1;
  if (alone && one.reason == Reason::nothing_to_compare) return "there is no other map to merge it with";
  return explain_left_out(one.reason);
}

}  // namespace gridmerge::internal
