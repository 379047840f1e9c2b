// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ceres/ceres.h>

#include <vector>

#include "similarity/likelihood_field.hpp"

namespace gridmerge::internal {

/// How far the moving map's walls lie from the fixed map's, as residuals of both poses (x, y, theta).
///
/// A residual is a wall's distance d to the nearest wall of the fixed map, in standard deviations, flattened
/// to c d / sqrt(d^2 + c^2) (Geman and McClure 1985): what lies far off, because the maps differ there, pulls
/// no more. Walls that lie where the fixed map has not seen count as unrelated ones do, so that nothing is
/// gained by leaving what it has seen. All together they weigh as much as a fixed number of independent
/// walls, since neighbouring ones say the same.
class WallError : public ceres::CostFunction {
 public:
  /// Both maps must have cells of one size; `fixed` must outlive this. The poses are of frames whose origins
  /// are at the given points of the map frames [m]. Distances of `sd` [cells] are usual.
  WallError(const LikelihoodField& fixed, const Point2& fixed_middle, const LikelihoodField& moving,
            const Point2& moving_middle, double sd);

  bool Evaluate(const double* const* poses, double* residuals, double** jacobians) const override;

 private:
  struct Field {
    double distance;  // [cells]
    double dx, dy;    // its gradient
  };
  Field field_at(double x, double y) const;

  const LikelihoodField& fixed_;
  SE2 T_grid_fixed_;            // from the fixed map's frame [m]
  std::vector<Point2> points_;  // of the moving map [m, its frame]
  double sd_;                   // [cells]
  double weight_;
};

}  // namespace gridmerge::internal
