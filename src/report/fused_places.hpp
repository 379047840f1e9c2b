// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "gridmerge/merge/merge_result.hpp"

namespace gridmerge::internal {

/// The places of the members that the merge has fused to its merged map `component`: of copies that lie on
/// each other the first, and all whose poses were known, as merge() does it; up a tree all. O(cells + joins).
std::vector<std::size_t> fused_places(const MergeResult& merge, std::size_t component,
                                      const std::vector<OccupancyGrid>& maps);

}  // namespace gridmerge::internal
