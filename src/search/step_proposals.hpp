// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <deque>
#include <random>

#include "gridmerge/search/random_walk.hpp"

namespace gridmerge::internal {

/// The steps that a walk tries: normal ones, with the mean and the covariance of its last accepted steps
/// (Birk & Carpin 2006, algorithm 1). Its axes' deviations stay between the options' smallest and largest
/// step.
class StepProposals {
 public:
  /// x, y, and the way of a cell at the moving map's radius when it turns [cells].
  using Step = Eigen::Vector3d;

  /// So many steps make a covariance of three numbers.
  static constexpr std::size_t kMinMemory = 4;

  /// `options` must live as long.
  explicit StepProposals(const RandomWalkOptions& options)
      : options_(options), deviations_(Step::Constant(options.first_step)) {}

  Step draw(std::mt19937_64& random);

  /// Samples that are refused again and again come from steps that are too large, or lead the wrong way. True
  /// when the steps cannot become smaller, and start again at their size.
  bool learn_refusal();

  /// What was learnt elsewhere says nothing of here.
  void start_anew();

  /// The first kMinMemory - 1 steps change nothing but the size, which is whole again. O(options.memory).
  void learn(const Step& accepted);

 private:
  const RandomWalkOptions& options_;
  std::deque<Step> steps_;
  Step mean_ = Step::Zero();
  Eigen::Matrix3d axes_ = Eigen::Matrix3d::Identity();  // of the covariance
  Step deviations_;                                     // along them
  double scale_ = 1.0;                                  // of the steps, since the last accepted one
  int refused_ = 0;                                     // since then
  std::normal_distribution<double> normal_;
};

}  // namespace gridmerge::internal
