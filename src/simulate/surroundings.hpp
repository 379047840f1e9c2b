// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gridmerge/simulate/simulate.hpp"

namespace gridmerge::internal {

/// Throws std::invalid_argument for sides that no invented building has [m].
void validate_sides(double width, double height);

/// Whether a point lies no farther beyond a building's sides than the longest side of one; no point that is
/// not finite does. So rasters of what lies about a building have a size that is known.
inline bool is_near(const Building& building, const Point2& p) {
  return p.x >= -kMaxBuildingSide && p.x <= building.width + kMaxBuildingSide && p.y >= -kMaxBuildingSide &&
         p.y <= building.height + kMaxBuildingSide;
}

}  // namespace gridmerge::internal
