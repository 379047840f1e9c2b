// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "evaluate/known_moments.hpp"
#include "gridmerge/evaluate/evaluate.hpp"

namespace gridmerge {

namespace internal {

KnownMoments known_moments(const OccupancyGrid& map) {
  // In cells about the grid's middle, row by row: within a row all sums are exact integers, and keeping the
  // coordinates small keeps the final subtraction accurate.
  const double middle_column = 0.5 * (map.width - 1);
  const double middle_row = 0.5 * (map.height - 1);
  double count = 0.0, sum_x = 0.0, sum_y = 0.0, sum_squares = 0.0;
  for (int row = 0; row < map.height; ++row) {
    const double y = row - middle_row;
    double row_count = 0.0, row_x = 0.0, row_xx = 0.0;
    for (int column = 0; column < map.width; ++column) {
      if (map.at(column, row) == Cell::unknown) continue;
      const double x = column - middle_column;
      row_count += 1.0;
      row_x += x;
      row_xx += x * x;
    }
    count += row_count;
    sum_x += row_x;
    sum_y += row_count * y;
    sum_squares += row_xx + row_count * y * y;
  }

  const double mean_x = count > 0.0 ? sum_x / count : 0.0;
  const double mean_y = count > 0.0 ? sum_y / count : 0.0;
  const double mean_square = count > 0.0 ? sum_squares / count : 0.0;
  const double spread = std::fmax(0.0, mean_square - mean_x * mean_x - mean_y * mean_y);
  return {map.origin * Point2{(mean_x + 0.5 * map.width) * map.resolution,
                              (mean_y + 0.5 * map.height) * map.resolution},
          spread * map.resolution * map.resolution};
}

double rms_displacement(const KnownMoments& moving, const SE2& T_estimate, const SE2& T_truth) {
  // A cell at centroid + q moves by d + (R_estimate - R_truth) q, where d is how far the centroid moves. The
  // q sum to zero, and the difference of two rotations by an angle a stretches every q by 2 sin(a / 2).
  const Point2 estimate = T_estimate * moving.centroid;
  const Point2 truth = T_truth * moving.centroid;
  const double stretch = 2.0 * std::sin(0.5 * (T_estimate.theta - T_truth.theta));
  const double turned = stretch * std::sqrt(moving.mean_square_radius);
  return std::hypot(estimate.x - truth.x, estimate.y - truth.y, turned);
}

}  // namespace internal

double rms_displacement(const OccupancyGrid& moving, const SE2& T_estimate, const SE2& T_truth) {
  validate(moving);
  return rms_displacement(internal::known_moments(moving), T_estimate, T_truth);
}

}  // namespace gridmerge
