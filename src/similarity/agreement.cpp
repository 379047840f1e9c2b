// SPDX-License-Identifier: Apache-2.0
#include "gridmerge/similarity/agreement.hpp"

#include <algorithm>
#include <cmath>

#include "gridmerge/grid/cancellation.hpp"

namespace gridmerge {

AgreementCounter::AgreementCounter(const OccupancyGrid& fixed, const OccupancyGrid& moving, int stride)
    : fixed_(fixed), moving_(moving), stride_(stride) {
  for (int row = stride / 2; row < moving.height; row += stride) {
    throw_if_cancelled();
    const std::size_t begin = known_.size();
    for (int column = stride / 2; column < moving.width; column += stride) {
      const Cell value = moving.at(column, row);
      if (value != Cell::unknown) known_.push_back({column, value});
    }
    if (known_.size() > begin) rows_.push_back({row, begin, known_.size()});
  }
}

AgreementCounts AgreementCounter::count(const SE2& T_fixed_moving) const {
  const SE2 T_fixedgrid_movinggrid = inverse(fixed_.origin) * T_fixed_moving * moving_.origin;
  const double scale = moving_.resolution / fixed_.resolution;
  const double step_x = std::cos(T_fixedgrid_movinggrid.theta) * scale;
  const double step_y = std::sin(T_fixedgrid_movinggrid.theta) * scale;

  AgreementCounts result;
  for (const Row& row : rows_) {
    throw_if_cancelled();
    const double row_x = T_fixedgrid_movinggrid.x / fixed_.resolution - step_y * (row.row + 0.5);
    const double row_y = T_fixedgrid_movinggrid.y / fixed_.resolution + step_x * (row.row + 0.5);
    for (std::size_t i = row.begin; i < row.end; ++i) {
      const double x = row_x + step_x * (known_[i].column + 0.5);
      const double y = row_y + step_y * (known_[i].column + 0.5);
      if (!(x >= 0.0 && y >= 0.0 && x < fixed_.width && y < fixed_.height)) continue;
      const Cell theirs = fixed_.at(static_cast<int>(x), static_cast<int>(y));
      if (theirs == Cell::unknown) continue;
      ++(known_[i].value == theirs ? result.agreement : result.disagreement);
    }
  }

  result.agreement *= static_cast<std::int64_t>(stride_) * stride_;
  result.disagreement *= static_cast<std::int64_t>(stride_) * stride_;
  return result;
}

AgreementCounts count_agreement(const OccupancyGrid& fixed, const OccupancyGrid& moving,
                                const SE2& T_fixed_moving) {
  return AgreementCounter(fixed, moving).count(T_fixed_moving);
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
