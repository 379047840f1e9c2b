// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "gridmerge/io/map_file.hpp"
#include "internal_export.hpp"

namespace gridmerge::internal {

/// Adds what is odd about a map's cells, wherever it came from: a kind that is missing, or the unseen painted
/// black. O(cells).
GRIDMERGE_INTERNAL_EXPORT void warn_of_missing_cells(const OccupancyGrid& grid,
                                                     std::vector<MapWarning>& warnings);

}  // namespace gridmerge::internal
