// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "gridmerge/grid/se2.hpp"
#include "internal_export.hpp"

namespace gridmerge::internal {

/// The 4 x 4 shifts of a lattice that a point depends on, and how much on each: on the one at
/// (column + a, row + b) as x[a] * y[b].
struct SplineWeights {
  int column = 0;
  int row = 0;
  std::array<double, 4> x{};
  std::array<double, 4> y{};
};

/// B_0 to B_3 of a uniform cubic B-spline at t in [0, 1].
inline std::array<double, 4> cubic_basis(double t) {
  const double s = 1.0 - t, t2 = t * t, t3 = t2 * t;
  return {s * s * s / 6.0, (3.0 * t3 - 6.0 * t2 + 4.0) / 6.0, (-3.0 * t3 + 3.0 * t2 + 3.0 * t + 1.0) / 6.0,
          t3 / 6.0};
}

/// Of a point of the lattice's frame [spacings]; beyond the lattice those of the nearest point of its rim.
inline SplineWeights spline_weights(const Point2& at, int columns, int rows) {
  const auto clamped = [](double value, int points) {
    return std::fmin(std::fmax(value, 0.0), static_cast<double>(points - 3));  // NaN becomes 0
  };
  const double x = clamped(at.x, columns), y = clamped(at.y, rows);
  const int column = std::min(static_cast<int>(x), columns - 4),
            row = std::min(static_cast<int>(y), rows - 4);
  return {column, row, cubic_basis(x - column), cubic_basis(y - row)};
}

/// The weighted sum of a lattice's shifts.
inline Point2 interpolated(const SplineWeights& weights, const Point2* shifts, int columns) {
  Point2 sum;
  for (int b = 0; b < 4; ++b) {
    const Point2* const row =
        shifts + static_cast<std::ptrdiff_t>(weights.row + b) * columns + weights.column;
    const auto [x0, x1, x2, x3] = weights.x;
    sum.x += weights.y[b] * (x0 * row[0].x + x1 * row[1].x + x2 * row[2].x + x3 * row[3].x);
    sum.y += weights.y[b] * (x0 * row[0].y + x1 * row[1].y + x2 * row[2].y + x3 * row[3].y);
  }
  return sum;
}

/// An upper bound of the derivative of what they interpolate (Frobenius norm of the Jacobian matrix): each of
/// its columns is a weighted mean of differences of neighbours. O(shifts).
GRIDMERGE_INTERNAL_EXPORT double strain_bound(const std::vector<Point2>& shifts, int columns, int rows,
                                              double spacing);

}  // namespace gridmerge::internal
