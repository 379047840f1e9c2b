// SPDX-License-Identifier: Apache-2.0
#include "merge/wall_error.hpp"

#include <algorithm>
#include <cmath>

#include "similarity/evidence.hpp"

namespace gridmerge::internal {

namespace {

constexpr std::size_t kWalls = 300;         // that are looked at
constexpr double kIndependentWalls = 30.0;  // that they weigh as much as
constexpr double kFlattened = 2.0;          // standard deviations: the c above
constexpr double kUnrelated = 2.0;          // standard deviations that an unrelated wall is off, about

}  // namespace

WallError::WallError(const LikelihoodField& fixed, const Point2& fixed_middle, const LikelihoodField& moving,
                     const Point2& moving_middle, double sd)
    : fixed_(fixed),
      T_grid_fixed_(inverse(fixed.T_map_grid) * SE2{fixed_middle.x, fixed_middle.y, 0.0}),
      sd_(sd) {
  const ManyPointsTransform T_map_grid(moving.T_map_grid);
  for (const WallPoint& wall : draw_evenly(moving.walls, kWalls)) {
    const Point2 at = T_map_grid * Point2{wall.position.x * moving.cell, wall.position.y * moving.cell};
    points_.push_back({at.x - moving_middle.x, at.y - moving_middle.y});
  }
  weight_ = std::sqrt(
      std::min(1.0, kIndependentWalls / static_cast<double>(std::max<std::size_t>(1, points_.size()))));
  set_num_residuals(static_cast<int>(points_.size()));
  mutable_parameter_block_sizes()->assign({3, 3});
}

/// Between the middles of four cells, of which all must be seen.
WallError::Field WallError::field_at(double x, double y) const {
  const Field unseen{kUnrelated * sd_, 0.0, 0.0};
  const double column = std::floor(x - 0.5), row = std::floor(y - 0.5);
  if (!(column >= 0.0 && row >= 0.0 && column + 1.0 < fixed_.width && row + 1.0 < fixed_.height))
    return unseen;
  const std::size_t at = fixed_.index(static_cast<int>(column), static_cast<int>(row));
  const auto distance = [&](std::size_t i) { return fixed_.places[i].distance; };
  const std::size_t above = at + static_cast<std::size_t>(fixed_.width);
  if (distance(at) == kUnseen || distance(at + 1) == kUnseen || distance(above) == kUnseen ||
      distance(above + 1) == kUnseen)
    return unseen;
  const double u = x - 0.5 - column, v = y - 0.5 - row;
  const double a = distance(at), b = distance(at + 1), c = distance(above), d = distance(above + 1);
  return {(1.0 - v) * ((1.0 - u) * a + u * b) + v * ((1.0 - u) * c + u * d),
          (1.0 - v) * (b - a) + v * (d - c), (1.0 - u) * (c - a) + u * (d - b)};
}

bool WallError::Evaluate(const double* const* poses, double* residuals, double** jacobians) const {
  const double* fixed = poses[0];
  const double* moving = poses[1];
  const double cf = std::cos(fixed[2]), sf = std::sin(fixed[2]);
  const double cm = std::cos(moving[2]), sm = std::sin(moving[2]);
  const double cg = std::cos(T_grid_fixed_.theta), sg = std::sin(T_grid_fixed_.theta);
  const ManyPointsTransform T_grid_fixed(T_grid_fixed_);
  const double flattened = kFlattened * sd_;
  for (std::size_t i = 0; i < points_.size(); ++i) {
    // m: the point turned with the moving map; u: in the fixed map's frame; q: in its grid, in cells.
    const double mx = cm * points_[i].x - sm * points_[i].y, my = sm * points_[i].x + cm * points_[i].y;
    const double wx = mx + moving[0] - fixed[0], wy = my + moving[1] - fixed[1];
    const double ux = cf * wx + sf * wy, uy = -sf * wx + cf * wy;
    const Point2 q = T_grid_fixed * Point2{ux, uy};
    const Field field = field_at(q.x / fixed_.cell, q.y / fixed_.cell);
    const double root = std::sqrt(field.distance * field.distance + flattened * flattened);
    residuals[i] = weight_ * flattened * field.distance / root / sd_;
    if (jacobians == nullptr) continue;
    // Of the residual by u, through the distance.
    const double ratio = flattened / root;
    const double by_distance = weight_ * ratio * ratio * ratio / sd_ / fixed_.cell;
    const double gx = by_distance * (cg * field.dx + sg * field.dy);
    const double gy = by_distance * (-sg * field.dx + cg * field.dy);
    const double tx = cf * gx - sf * gy, ty = sf * gx + cf * gy;  // by the world's x and y
    if (jacobians[0] != nullptr) {
      double* row = jacobians[0] + 3 * i;
      row[0] = -tx;
      row[1] = -ty;
      row[2] = gx * uy - gy * ux;
    }
    if (jacobians[1] != nullptr) {
      double* row = jacobians[1] + 3 * i;
      row[0] = tx;
      row[1] = ty;
      row[2] = -tx * my + ty * mx;
    }
  }
  return true;
}

}  // namespace gridmerge::internal
