// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "gridmerge/merge/merge_result.hpp"
#include "internal_export.hpp"

namespace gridmerge::internal {

/// The maps that are bent, as they lie; nothing for the others. Several are drawn at once. O(cells).
GRIDMERGE_INTERNAL_EXPORT std::vector<std::optional<OccupancyGrid>> bent_maps(
    const std::vector<OccupancyGrid>& maps, const MergeResult& result);

}  // namespace gridmerge::internal
