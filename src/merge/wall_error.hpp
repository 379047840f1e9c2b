// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ceres/ceres.h>

#include <vector>

#include "gridmerge/similarity/wall_map.hpp"

namespace gridmerge {

/// How far the moving map's walls lie from the fixed map's, as residuals of both poses (x, y, theta).
///
/// A residual is a wall's distance d to the nearest wall of the fixed map, in standard deviations, flattened
/// to c d / sqrt(d^2 + c^2) (Geman and McClure 1985): what lies far off, because the maps differ there, pulls
/// no more. Walls that lie where the fixed map has not seen have none. All together they weigh as much as a
/// fixed number of independent walls, since neighbouring ones say the same.
class WallError : public ceres::CostFunction {
 public:
  /// Both maps must have cells of one size; `fixed` must outlive this. Distances of `sd` [cells] are usual.
  WallError(const WallMap& fixed, const WallMap& moving, double sd);

  bool Evaluate(const double* const* poses, double* residuals, double** jacobians) const override;

  bool empty() const { return points_.empty(); }

 private:
  struct Field {
    double distance;  // [cells]
    double dx, dy;    // its gradient
    bool is_seen;
  };
  Field field_at(double x, double y) const;

  const WallMap& fixed_;
  std::vector<Point2> points_;  // of the moving map [m, its map frame]
  double sd_;                   // [cells]
  double weight_;
};

}  // namespace gridmerge
