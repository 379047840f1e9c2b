// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "gridmerge/grid/se2.hpp"
#include "gridmerge/match/match.hpp"
#include "internal_export.hpp"

namespace gridmerge::internal {

/// Where the report page lays a map.
struct LaidMap {
  std::size_t map = 0;  ///< index of the input map
  SE2 T_page_map;       ///< takes the map's frame to one that all maps of a request have in common
};

/// What the report page asks its server: how does `moving` lie on `fixed`, from about here?
struct RefineRequest {
  LaidMap moving;
  std::vector<LaidMap> fixed;  ///< one or more, each another map
};

/// Reads a request (docs/view.md). It numbers maps as the page of the merge does that it names, and `maps_of`
/// says how many that merge has, or throws. Throws std::invalid_argument, "fixed[1].map is no map: ...", for
/// what it cannot use: coordinates beyond 1e7 m and angles beyond 100 rad, too. O(bytes).
GRIDMERGE_INTERNAL_EXPORT RefineRequest parse_refine_request(
    std::string_view text, const std::function<std::size_t(const std::string& merge)>& maps_of);

/// The answer: one line of JSON, with its end.
GRIDMERGE_INTERNAL_EXPORT std::string refined_pose_json(const RefinedPose& pose);

}  // namespace gridmerge::internal
