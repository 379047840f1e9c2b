// SPDX-License-Identifier: Apache-2.0
#include "simulate/mapper.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <stdexcept>

#include "grid/logistic.hpp"
#include "gridmerge/grid/message_values.hpp"
#include "gridmerge/grid/resample.hpp"

namespace gridmerge::internal {

namespace {

constexpr float kHit = 0.85F;
constexpr float kMiss = -0.5F;
constexpr float kMax = 4.0F;  // either way

}  // namespace

Mapper::Mapper(double resolution, const Box& reach) : resolution_(resolution) {
  const double left = std::floor(reach.min_x / resolution),
               right = std::floor(reach.max_x / resolution) + 1.0;
  const double bottom = std::floor(reach.min_y / resolution),
               top = std::floor(reach.max_y / resolution) + 1.0;
  if (!((right - left) * (top - bottom) <= kMaxGridCells))
    throw std::invalid_argument("a robot's map would exceed 2^28 cells: a coarser resolution helps");
  raster_ = {static_cast<int>(left), static_cast<int>(bottom), static_cast<int>(right),
             static_cast<int>(top)};
  log_odds_.assign(static_cast<std::size_t>(raster_.width()) * static_cast<std::size_t>(raster_.height()),
                   std::numeric_limits<float>::quiet_NaN());
}

void Mapper::update(int column, int row, float evidence) {
  if (column < raster_.left || row < raster_.bottom || column >= raster_.right || row >= raster_.top) return;
  float& cell = log_odds_[static_cast<std::size_t>(row - raster_.bottom) * raster_.width() +
                          static_cast<std::size_t>(column - raster_.left)];
  cell = std::clamp((std::isnan(cell) ? 0.0F : cell) + evidence, -kMax, kMax);
}

void Mapper::add_beam(Point2 from, Point2 to, bool hits) {
  const double x0 = from.x / resolution_, y0 = from.y / resolution_;
  const double dx = to.x / resolution_ - x0, dy = to.y / resolution_ - y0;
  int column = static_cast<int>(std::floor(x0));
  int row = static_cast<int>(std::floor(y0));
  const int last_column = static_cast<int>(std::floor(x0 + dx));
  const int last_row = static_cast<int>(std::floor(y0 + dy));
  const int step_x = dx < 0.0 ? -1 : 1;
  const int step_y = dy < 0.0 ? -1 : 1;
  // Shares of the beam at which it crosses the next border of a cell, along x and along y.
  constexpr double kNever = std::numeric_limits<double>::infinity();
  double next_x = dx == 0.0 ? kNever : (column + (step_x > 0 ? 1 : 0) - x0) / dx;
  double next_y = dy == 0.0 ? kNever : (row + (step_y > 0 ? 1 : 0) - y0) / dy;
  int crossings = std::abs(last_column - column) + std::abs(last_row - row);
  while (crossings-- > 0) {
    update(column, row, kMiss);
    if ((next_x < next_y && column != last_column) || row == last_row) {
      column += step_x;
      next_x += std::abs(1.0 / dx);
    } else {
      row += step_y;
      next_y += std::abs(1.0 / dy);
    }
  }
  update(last_column, last_row, hits ? kHit : kMiss);
}

OccupancyGrid Mapper::grid() const {
  OccupancyGrid grid = make_grid(raster_.width(), raster_.height(), resolution_,
                                 {raster_.left * resolution_, raster_.bottom * resolution_, 0.0});
  grid.probability.assign(grid.cells.size(), std::numeric_limits<float>::quiet_NaN());
  for (std::size_t i = 0; i < log_odds_.size(); ++i) {
    if (std::isnan(log_odds_[i])) continue;
    const double probability = logistic(static_cast<double>(log_odds_[i]));
    grid.probability[i] = static_cast<float>(probability);
    if (probability > kOccupiedThreshold) grid.cells[i] = Cell::occupied;
    if (probability < kFreeThreshold) grid.cells[i] = Cell::free;
  }
  OccupancyGrid cropped = crop_to_known(grid);
  // To the bit the same whatever the raster: so many whole cells from the frame's origin.
  for (double* const side : {&cropped.origin.x, &cropped.origin.y})
    *side = std::round(*side / resolution_) * resolution_;
  return cropped;
}

}  // namespace gridmerge::internal
