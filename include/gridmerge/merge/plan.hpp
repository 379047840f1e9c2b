// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "gridmerge/export.hpp"
#include "gridmerge/grid/occupancy_grid.hpp"
#include "gridmerge/match/match.hpp"
#include "gridmerge/merge/merge.hpp"
#include "gridmerge/merge/merge_result.hpp"

namespace gridmerge {

/// How maps are hung on an architect's plan.
struct PlanOptions {
  ScaleRange scales{0.5, 2.0};  ///< the factors by which the plan may be too small, as MatchOptions::scales
  std::string name = "plan";    ///< what outputs call the plan
  /// Called with the numbers of maps that are matched with the plan and to be matched, never from two threads
  /// at once.
  std::function<void(std::size_t, std::size_t)> progress;
};

/// Throws std::invalid_argument, without naming the plan, for one that is no valid grid, has no walls, or has
/// the cells of one of the maps. O(cells).
GRIDMERGE_EXPORT void validate_plan(const std::vector<OccupancyGrid>& maps, const OccupancyGrid& plan);

/// Hangs what merge() made of `maps` on an architect's plan of unknown scale: a line drawing, or a map.
///
/// Each component and each map that was left out is a part. Its merged map and its members are matched with
/// the plan (see MatchOptions::scales), and what they say together decides: members that see the part
/// elsewhere on the plan count against it. The surest part decides the plan's scale, if it is as probable as
/// `options.match.accept_probability`. Of the others, what lies within 4 % of it counts. They hang on the
/// plan if they are as probable, with what their maps and those that hang there say of each other, and if
/// `options.max_false_joins` allows it: so many parts on the plan may be expected to be false (of more than
/// 50 maps, so many for every 50), beside the false joins within parts. All parts on the plan become one
/// component, in the plan's frame at that scale. Parts of which nothing is sure stay as they were.
/// MergeResult::plan tells of all.
///
/// Within a part nothing moves, and the plan is no part of the merged map. `merged` is what merge() returned
/// for these maps and options. Neither the number of threads nor the order of the maps plays a part. Throws
/// std::invalid_argument for an invalid grid or option, what validate_plan() refuses, a result with a fixed
/// pose or of other maps, and when a merged map would exceed kMaxGridCells. A match at all scales, which
/// takes some ten times as long as one at a single scale, for each part and for up to 16 members of it.
GRIDMERGE_EXPORT MergeResult place_on_plan(const std::vector<OccupancyGrid>& maps, const OccupancyGrid& plan,
                                           MergeResult merged, const MergeOptions& options = {},
                                           const PlanOptions& plan_options = {});

}  // namespace gridmerge
