// SPDX-License-Identifier: Apache-2.0
// The ways in which parts of a merge may lie on a plan, and how probable each is.
#pragma once

#include <optional>
#include <vector>

#include "gridmerge/match/match.hpp"
#include "merge/plan_parts.hpp"

namespace gridmerge::internal {

/// Scales whose logarithms differ by no more are one: bent maps have no exact scale.
inline constexpr double kSameScale = 0.04;

/// A way in which a part may lie on the plan.
struct PlanWay {
  SE2 T_plan_part;           ///< to the plan's frame, in metres of the maps
  double scale = 1.0;        ///< by which the plan is too small
  double probability = 0.0;  ///< against lying otherwise, at any scale, and not at all
  double sd = 0.0;           ///< if it is true: standard deviation of the displacement [m]
};

/// The most probable way of a part by itself, by what its voices say of the plan at all scales; none if they
/// say nothing. Poses are weighed as find_consistent_set() weighs them, the plan being a map. Runs in the
/// calling TBB arena.
std::optional<PlanWay> best_way(const MergePart& part, const PreparedMap& plan);

/// Leaves of what the part's voices have found at all `scales` what is of one that is known by now.
/// Hypotheses of other scales are rivals no more, and what fits by chance fits elsewhere: "none of these" is
/// less likely by the share of the range that is left. O(hypotheses).
void know_scale(MergePart& part, double scale, const ScaleRange& scales);

/// A part that hangs on the plan.
struct HungPart {
  const MergePart* part;
  SE2 T_plan_part;
};

/// The same at a scale that all parts know by now, with what the part's maps and those of parts that hang on
/// the plan say of each other. `joins` are those of the merge.
std::optional<PlanWay> best_way_beside(const MergePart& part, const std::vector<HungPart>& hung, double scale,
                                       const PreparedMap& plan, const std::vector<Join>& joins);

}  // namespace gridmerge::internal
