// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "gridmerge/merge/merge_result.hpp"
#include "merge/plan_ways.hpp"

namespace gridmerge::internal {

/// A part that hangs on the plan, and how.
struct OnPlan {
  const MergePart* part;
  PlanWay way;
};

/// Makes one component, in the plan's frame, of the parts on the plan, in the place of what they were: fused
/// in one pass in cells of `resolution` metres, 0 for the finest. Ways that led from one of them to another
/// are open no more, and their doubts are added to the joins that are expected to be false. A map that hangs
/// there alone stays left out. O(cells).
void join_on_plan(const std::vector<OnPlan>& hung, const PlanInputs& inputs, double resolution,
                  MergeResult& merged);

}  // namespace gridmerge::internal
