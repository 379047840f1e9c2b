// SPDX-License-Identifier: Apache-2.0
// Residuals and solver of pose optimisation, for files that use Ceres.
#pragma once

#include <ceres/ceres.h>

#include "pose_graph.hpp"

namespace gridmerge {

/// How far two poses (x, y, theta) put the moving map from where it was measured: the pivot's displacement
/// and the turn at the radius, in standard deviations.
class RelativePoseError {
 public:
  explicit RelativePoseError(const RelativePose& measured) : measured_(measured) {}

  static ceres::CostFunction* make(const RelativePose& measured) {
    return new ceres::AutoDiffCostFunction<RelativePoseError, 3, 3, 3>(new RelativePoseError(measured));
  }

  template <typename T>
  bool operator()(const T* fixed, const T* moving, T* residual) const {
    const SE2& m = measured_.T_fixed_moving;
    const Point2& p = measured_.pivot;
    // The pivot in the common frame by the moving pose, and by the fixed pose and what was measured.
    const T cm = cos(moving[2]), sm = sin(moving[2]);
    const T x = cm * p.x - sm * p.y + moving[0];
    const T y = sm * p.x + cm * p.y + moving[1];
    const Point2 q = m * p;
    const T cf = cos(fixed[2]), sf = sin(fixed[2]);
    residual[0] = (x - (cf * q.x - sf * q.y + fixed[0])) / measured_.sd_position;
    residual[1] = (y - (sf * q.x + cf * q.y + fixed[1])) / measured_.sd_position;
    const T turn = moving[2] - fixed[2] - m.theta;
    // Twice the sine of half the turn: the same for every whole turn, and its square is what displacement()
    // sums up.
    residual[2] = 2.0 * sin(0.5 * turn) * measured_.radius / measured_.sd_position;
    return true;
  }

 private:
  RelativePose measured_;
};

/// Solves small dense problems the same way everywhere.
inline void solve(ceres::Problem& problem) {
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_NORMAL_CHOLESKY;
  options.max_num_iterations = 50;
  options.function_tolerance = 1e-10;
  options.parameter_tolerance = 1e-12;
  options.num_threads = 1;
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
}

}  // namespace gridmerge
