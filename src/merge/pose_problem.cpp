// SPDX-License-Identifier: Apache-2.0
#include "merge/pose_problem.hpp"

#include <ceres/crs_matrix.h>

#include <Eigen/OrderingMethods>
#include <Eigen/SparseCore>
#include <Eigen/SparseQR>
#include <cmath>
#include <memory>
#include <stdexcept>
#include <utility>

namespace gridmerge::internal {

namespace {

/// Jacobians of more poses than this are kept sparse.
constexpr std::size_t kDensePoses = 5;

/// How far two poses put the moving frame from where it was measured: the pivot's displacement and the turn,
/// in standard deviations.
class RelativePoseError {
 public:
  explicit RelativePoseError(const RelativePose& measured) : measured_(measured) {}

  template <typename T>
  bool operator()(const T* fixed, const T* moving, T* residual) const {
    const Point2& p = measured_.pivot;
    const Point2 q = measured_.T_fixed_moving * p;
    // The pivot in the common frame, by the moving pose, and by the fixed pose and what was measured.
    const T cm = cos(moving[2]), sm = sin(moving[2]);
    const T cf = cos(fixed[2]), sf = sin(fixed[2]);
    const T dx = cm * p.x - sm * p.y + moving[0] - (cf * q.x - sf * q.y + fixed[0]);
    const T dy = sm * p.x + cm * p.y + moving[1] - (sf * q.x + cf * q.y + fixed[1]);
    residual[0] = dx / measured_.sd_position;
    residual[1] = dy / measured_.sd_position;
    // Twice the sine of half the turn: the same for every whole turn.
    residual[2] =
        2.0 * sin(0.5 * (moving[2] - fixed[2] - measured_.T_fixed_moving.theta)) / measured_.sd_theta;
    return true;
  }

 private:
  RelativePose measured_;
};

SE2 shift(const Point2& by) {
  return {by.x, by.y, 0.0};
}

}  // namespace

std::size_t PoseProblem::add_pose(const SE2& pose, const Point2& middle, bool held) {
  if (blocks_.size() == blocks_.capacity()) throw std::length_error("a pose problem has no room for a pose");
  const Point2 place = pose * middle;
  Block& block = blocks_.emplace_back(Block{{place.x, place.y, pose.theta}, middle, held});
  problem_.AddParameterBlock(block.values.data(), 3);
  if (held) problem_.SetParameterBlockConstant(block.values.data());
  return blocks_.size() - 1;
}

void PoseProblem::add(const RelativePose& measured) {
  RelativePose between = measured;
  const Point2 &fixed = blocks_[measured.fixed].middle, &moving = blocks_[measured.moving].middle;
  between.T_fixed_moving = inverse(shift(fixed)) * measured.T_fixed_moving * shift(moving);
  between.pivot = {measured.pivot.x - moving.x, measured.pivot.y - moving.y};
  problem_.AddResidualBlock(
      new ceres::AutoDiffCostFunction<RelativePoseError, 3, 3, 3>(new RelativePoseError(between)),
      new ceres::HuberLoss(1.0), blocks_[measured.fixed].values.data(),
      blocks_[measured.moving].values.data());
}

void PoseProblem::add(std::size_t fixed, std::size_t moving, std::unique_ptr<ceres::CostFunction> error) {
  problem_.AddResidualBlock(error.release(), nullptr, blocks_[fixed].values.data(),
                            blocks_[moving].values.data());
}

void PoseProblem::solve() {
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_NORMAL_CHOLESKY;
  if (blocks_.size() > kDensePoses && ceres::IsSparseLinearAlgebraLibraryTypeAvailable(ceres::EIGEN_SPARSE)) {
    options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
    options.sparse_linear_algebra_library_type = ceres::EIGEN_SPARSE;
  }
  options.max_num_iterations = 50;
  options.function_tolerance = 1e-10;
  options.parameter_tolerance = 1e-12;
  options.num_threads = 1;
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem_, &summary);
}

SE2 PoseProblem::pose(std::size_t number) const {
  const Block& block = blocks_[number];
  const SE2 middle{block.values[0], block.values[1], normalize_angle(block.values[2])};
  return middle * inverse(shift(block.middle));
}

namespace {

/// The variances of the unknowns of equations, by their derivatives; none where the equations do not
/// determine all. Ceres has them too, but no more where some unknowns are known a billion times better than
/// others, and prints it. Here each is measured in a unit of its own.
std::optional<Eigen::VectorXd> variances_of(const ceres::CRSMatrix& derivatives) {
  Eigen::SparseMatrix<double> equations = Eigen::Map<const Eigen::SparseMatrix<double, Eigen::RowMajor>>(
      derivatives.num_rows, derivatives.num_cols, static_cast<Eigen::Index>(derivatives.values.size()),
      derivatives.rows.data(), derivatives.cols.data(), derivatives.values.data());
  Eigen::VectorXd unit(equations.cols());
  for (Eigen::Index i = 0; i < equations.cols(); ++i) unit[i] = 1.0 / equations.col(i).norm();
  if (!unit.allFinite()) return std::nullopt;
  equations = equations * unit.asDiagonal();
  equations.makeCompressed();
  const Eigen::SparseQR<Eigen::SparseMatrix<double>, Eigen::COLAMDOrdering<int>> qr(equations);
  if (qr.info() != Eigen::Success || qr.rank() < equations.cols()) return std::nullopt;
  Eigen::VectorXd variances(equations.cols());
  for (Eigen::Index i = 0; i < equations.cols(); ++i) {
    // The squared length of R^-T e_i. R has no entry below its diagonal, so what is before i is 0.
    Eigen::VectorXd solution = Eigen::VectorXd::Zero(equations.cols());
    for (Eigen::Index column = i; column < equations.cols(); ++column) {
      double sum = column == i ? 1.0 : 0.0, diagonal = 0.0;
      for (Eigen::SparseMatrix<double>::InnerIterator entry(qr.matrixR(), column); entry; ++entry) {
        if (entry.row() == column) {
          diagonal = entry.value();
        } else {
          sum -= entry.value() * solution[entry.row()];
        }
      }
      solution[column] = sum / diagonal;
    }
    const Eigen::Index unknown = qr.colsPermutation().indices()[i];
    variances[unknown] = solution.squaredNorm() * unit[unknown] * unit[unknown];
  }
  return variances;
}

}  // namespace

std::vector<std::optional<PoseDeviation>> PoseProblem::deviations() {
  std::vector<std::optional<PoseDeviation>> deviations(blocks_.size());
  ceres::Problem::EvaluateOptions wanted;
  wanted.num_threads = 1;
  for (std::size_t i = 0; i < blocks_.size(); ++i) {
    if (blocks_[i].held) {
      deviations[i] = PoseDeviation{};
    } else {
      wanted.parameter_blocks.push_back(blocks_[i].values.data());
    }
  }
  ceres::CRSMatrix derivatives;
  if (wanted.parameter_blocks.empty() || !problem_.Evaluate(wanted, nullptr, nullptr, nullptr, &derivatives))
    return deviations;
  const std::optional<Eigen::VectorXd> variances = variances_of(derivatives);
  if (!variances) return deviations;
  Eigen::Index at = 0;
  for (std::size_t i = 0; i < blocks_.size(); ++i) {
    if (blocks_[i].held) continue;
    deviations[i] =
        PoseDeviation{std::sqrt((*variances)[at] + (*variances)[at + 1]), std::sqrt((*variances)[at + 2])};
    at += 3;
  }
  return deviations;
}

}  // namespace gridmerge::internal
