// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "gridmerge/similarity/image_similarity.hpp"
#include "internal_export.hpp"

namespace gridmerge::internal {

/// A PNG of a distance map in gray: black is distance 0, the farther the lighter, and white is the farthest.
/// Cells from which there is no distance are white too. One pixel per cell; a map of at most 40 cells per
/// side is magnified, and each cell's distance is written in it ("inf" for none). O(cells).
GRIDMERGE_INTERNAL_EXPORT std::string distance_map_png(const DistanceMap& map);

}  // namespace gridmerge::internal
