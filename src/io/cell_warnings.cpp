// SPDX-License-Identifier: Apache-2.0
#include "io/cell_warnings.hpp"

#include <fmt/format.h>

#include "grid/painted.hpp"

namespace gridmerge::internal {

void warn_of_missing_cells(const OccupancyGrid& grid, std::vector<MapWarning>& warnings) {
  const CellCounts counts = count_cells(grid);
  if (counts.known() == 0) {
    warnings.push_back({MapWarningKind::no_known_cell, "the map has no known cell"});
  } else if (counts.occupied == 0) {
    warnings.push_back({MapWarningKind::no_occupied_cell, "the map has no occupied cell"});
  } else if (counts.free == 0) {
    warnings.push_back({MapWarningKind::no_free_cell, "the map has no free cell"});
  } else if (is_mostly_painted(grid)) {
    warnings.push_back(
        {MapWarningKind::painted_black,
         fmt::format("{} of {} known cells are occupied, most of them far from any free one: was the unseen "
                     "painted black? "
                     "Matching and merging take them for unknown",
                     counts.occupied, counts.known())});
  }
}

}  // namespace gridmerge::internal
