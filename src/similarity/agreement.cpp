// SPDX-License-Identifier: Apache-2.0
#include "similarity/agreement.hpp"

#include <algorithm>
#include <cmath>

#include "gridmerge/grid/execution.hpp"

namespace gridmerge::internal {

namespace {

/// Looks cells of one map up in another one, row by row, under one pose.
class CellLookUp {
 public:
  CellLookUp(const OccupancyGrid& fixed, const OccupancyGrid& moving, const SE2& T_fixed_moving)
      : fixed_(fixed), T_grids_(inverse(fixed.origin) * T_fixed_moving * moving.origin) {
    const double scale = moving.resolution / fixed.resolution;
    step_x_ = std::cos(T_grids_.theta) * scale;
    step_y_ = std::sin(T_grids_.theta) * scale;
  }

  void begin_row(int row) {
    row_x_ = T_grids_.x / fixed_.resolution - step_y_ * (row + 0.5);
    row_y_ = T_grids_.y / fixed_.resolution + step_x_ * (row + 0.5);
  }

  void count(int column, Cell ours, AgreementCounts& counts) const {
    const double x = row_x_ + step_x_ * (column + 0.5);
    const double y = row_y_ + step_y_ * (column + 0.5);
    if (!(x >= 0.0 && y >= 0.0 && x < fixed_.width && y < fixed_.height)) return;
    const Cell theirs = fixed_.at(static_cast<int>(x), static_cast<int>(y));
    if (theirs == Cell::unknown) return;
    ++(ours == theirs ? counts.agreement : counts.disagreement);
  }

 private:
  const OccupancyGrid& fixed_;
  SE2 T_grids_;
  double step_x_;
  double step_y_;
  double row_x_ = 0.0;
  double row_y_ = 0.0;
};

}  // namespace

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
  CellLookUp look_up(fixed_, moving_, T_fixed_moving);
  AgreementCounts result;
  for (const Row& row : rows_) {
    throw_if_cancelled();
    look_up.begin_row(row.row);
    for (std::size_t i = row.begin; i < row.end; ++i)
      look_up.count(known_[i].column, known_[i].value, result);
  }
  result.agreement *= static_cast<std::int64_t>(stride_) * stride_;
  result.disagreement *= static_cast<std::int64_t>(stride_) * stride_;
  return result;
}

AgreementCounts count_agreement(const OccupancyGrid& fixed, const OccupancyGrid& moving,
                                const SE2& T_fixed_moving) {
  CellLookUp look_up(fixed, moving, T_fixed_moving);
  AgreementCounts result;
  for (int row = 0; row < moving.height; ++row) {
    throw_if_cancelled();
    look_up.begin_row(row);
    for (int column = 0; column < moving.width; ++column) {
      const Cell ours = moving.at(column, row);
      if (ours != Cell::unknown) look_up.count(column, ours, result);
    }
  }
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

}  // namespace gridmerge::internal
