// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "gridmerge/grid/occupancy_grid.hpp"
#include "gridmerge/grid/se2.hpp"
#include "gridmerge/report/merge_output.hpp"
#include "report/json_values.hpp"

namespace gridmerge::internal {

/// Where the plan lies under a merged map, or under a map that was left out: a point p of the plan's frame,
/// in the plan's own metres, lies at T_scene_plan * (scale * p).
struct PlanPlace {
  std::optional<std::size_t> component;  ///< whose frame it is; none: that of the map
  std::size_t map = 0;                   ///< the first one of the part
  SE2 T_scene_plan;
  double scale = 1.0;
  double probability = 0.0;
  bool on_plan = false;
};

/// One for each component and for each map that was left out of which a place is known, if only a guess.
std::vector<PlanPlace> plan_places(const MergeResult& result);

/// The lines that maps are hung on, gray ones too, and nothing of the paper. O(cells of the plan).
OccupancyGrid walls_of_plan(const OccupancyGrid& plan);

/// The plan of a merge that has one, as the report page takes it: which maps hang on it, and where it lies
/// under merged maps and maps that were left out. With its walls as cells if NamedMerge::plan is there; large
/// ones are shown coarser. O(cells of the plan).
Json plan_page_json(const NamedMerge& merge);

}  // namespace gridmerge::internal
