// SPDX-License-Identifier: Apache-2.0
#include "search/step_proposals.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace gridmerge::internal {

StepProposals::Step StepProposals::draw(std::mt19937_64& random) {
  Step step;
  for (int i = 0; i < 3; ++i)
    step[i] = std::max(scale_ * deviations_[i], options_.smallest_step) * normal_(random);
  return mean_ + axes_ * step;
}

bool StepProposals::learn_refusal() {
  constexpr int kPatience = 100;
  if (++refused_ % kPatience != 0) return false;
  scale_ *= 0.5;
  mean_.setZero();
  if (scale_ * deviations_.maxCoeff() >= options_.smallest_step) return false;
  scale_ = 1.0;
  return true;
}

void StepProposals::start_anew() {
  steps_.clear();
  mean_.setZero();
  axes_.setIdentity();
  deviations_.setConstant(options_.first_step);
  scale_ = 1.0;
  refused_ = 0;
}

void StepProposals::learn(const Step& accepted) {
  refused_ = 0;
  scale_ = 1.0;
  steps_.push_back(accepted);
  if (steps_.size() > options_.memory) steps_.pop_front();
  if (steps_.size() < kMinMemory) return;
  const double count = static_cast<double>(steps_.size());
  mean_.setZero();
  for (const Step& step : steps_) mean_ += step / count;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (const Step& step : steps_) covariance += (step - mean_) * (step - mean_).transpose() / (count - 1.0);
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(covariance);
  axes_ = eigen.eigenvectors();
  for (int i = 0; i < 3; ++i) {
    deviations_[i] = std::clamp(std::sqrt(std::max(0.0, eigen.eigenvalues()[i])), options_.smallest_step,
                                options_.largest_step);
  }
}

}  // namespace gridmerge::internal
