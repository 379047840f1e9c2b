// SPDX-License-Identifier: Apache-2.0
#include "similarity/lattice_frames.hpp"

#include <stdexcept>

namespace gridmerge::internal {

void check_finite(const SE2& T) {
  if (!is_finite(T)) throw std::invalid_argument("the transform must be finite");
}

SE2 between_grids(const OccupancyGrid& fixed, const OccupancyGrid& moving, const SE2& T_fixed_moving) {
  return inverse(fixed.origin) * T_fixed_moving * moving.origin;
}

void check_resolutions(const OccupancyGrid& fixed, const OccupancyGrid& moving) {
  constexpr double kMaxRatio = 100.0;  // keeps cells of either map within fixed-point arithmetic
  const double ratio = fixed.resolution / moving.resolution;
  if (!(ratio <= kMaxRatio && ratio >= 1.0 / kMaxRatio))
    throw std::invalid_argument("the maps' resolutions differ by more than 100 times");
}

}  // namespace gridmerge::internal
