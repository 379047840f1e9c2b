// SPDX-License-Identifier: Apache-2.0
#include "gridmerge/merge/merge_result.hpp"

#include "merge/left_out.hpp"

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

const char* explain(const MergeResult& result, const LeftOut& one) {
  const bool alone = result.components.empty() && result.left_out.size() == 1;
  if (alone && one.reason == Reason::nothing_to_compare) return "there is no other map to merge it with";
  return internal::explain_left_out(one.reason);
}

const char* explain(const PlanPart& part) {
  switch (part.reason) {
    case Reason::nothing_to_compare:
      return "there is too little to compare";
    case Reason::ambiguous:
      return "other places on the plan, or other scales of it, may fit as well";
    case Reason::contradiction:
      return "the plan has walls where there are none, or none where there are some";
    case Reason::too_little_overlap:
      return "the plan agrees, but on too little to be sure";
    case Reason::contradicts_others:
      return "what speaks for a place contradicts other maps";
    case Reason::over_budget:
      return "its place is too doubtful for the budget of false joins";
    case Reason::several:
    case Reason::none:
      break;
  }
  return "nothing speaks for a place on the plan clearly enough";
}

}  // namespace gridmerge
