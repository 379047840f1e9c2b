// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "gridmerge/grid/message_values.hpp"
#include "gridmerge/grid/occupancy_grid.hpp"

namespace gridmerge::internal {

/// A map with probabilities as an image of mode `raw`.
struct RawPixels {
  std::vector<std::uint8_t> pixels;  ///< percent, 255 where nothing is known; top row first
  OccupancyThresholds thresholds;    ///< with which the pixels are the map's cells, if any do
};

/// The probabilities, each as a percentage that is at most one off, and on the same side of the thresholds
/// as its cell. The thresholds are nav2's usual ones where these tell the cells apart, and else lie in the
/// middle between them: what merging calls free may be nearer to 50 percent than nav2 has it. Where
/// no such percentages are, the thresholds are the usual ones, and percentages are rounded to the nearest. A
/// known cell without a probability is 0 or 100 percent. `grid` has probabilities. O(cells).
RawPixels to_raw_pixels(const OccupancyGrid& grid);

}  // namespace gridmerge::internal
