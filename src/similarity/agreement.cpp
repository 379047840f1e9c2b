// SPDX-License-Identifier: Apache-2.0
#include "gridmerge/similarity/agreement.hpp"

#include <algorithm>
#include <cmath>

#include "gridmerge/grid/cancellation.hpp"

namespace gridmerge {

AgreementCounts count_agreement(const OccupancyGrid& fixed, const OccupancyGrid& moving,
                                const SE2& T_fixed_moving, int stride) {
  const SE2 T_fixedgrid_movinggrid = inverse(fixed.origin) * T_fixed_moving * moving.origin;
  const double scale = moving.resolution / fixed.resolution;
  const double step_x = std::cos(T_fixedgrid_movinggrid.theta) * scale;
  const double step_y = std::sin(T_fixedgrid_movinggrid.theta) * scale;

  AgreementCounts result;
  for (int row = stride / 2; row < moving.height; row += stride) {
    throw_if_cancelled();
    const double row_x = T_fixedgrid_movinggrid.x / fixed.resolution - step_y * (row + 0.5);
    const double row_y = T_fixedgrid_movinggrid.y / fixed.resolution + step_x * (row + 0.5);
    for (int column = stride / 2; column < moving.width; column += stride) {
      const Cell ours = moving.at(column, row);
      if (ours == Cell::unknown) continue;
      const double x = row_x + step_x * (column + 0.5);
      const double y = row_y + step_y * (column + 0.5);
      if (!(x >= 0.0 && y >= 0.0 && x < fixed.width && y < fixed.height)) continue;
      const Cell theirs = fixed.at(static_cast<int>(x), static_cast<int>(y));
      if (theirs == Cell::unknown) continue;
      ++(ours == theirs ? result.agreement : result.disagreement);
    }
  }

  result.agreement *= static_cast<std::int64_t>(stride) * stride;
  result.disagreement *= static_cast<std::int64_t>(stride) * stride;
  return result;
}

double measure_overlap(const OccupancyGrid& fixed, const OccupancyGrid& moving,
                       const AgreementCounts& counts) {
  const auto known_area = [](const OccupancyGrid& grid) {
    return static_cast<double>(count_cells(grid).known()) * grid.resolution * grid.resolution;
  };
  const double smaller = std::min(known_area(fixed), known_area(moving));
  const double both = static_cast<double>(counts.both_known()) * moving.resolution * moving.resolution;
  return smaller > 0.0 ? std::min(1.0, both / smaller) : 0.0;
}

}  // namespace gridmerge
