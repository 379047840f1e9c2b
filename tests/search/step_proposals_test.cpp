// SPDX-License-Identifier: Apache-2.0
#include "search/step_proposals.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace gridmerge::internal {
namespace {

using Step = StepProposals::Step;

struct Moments {
  Step mean = Step::Zero();
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
};

Moments moments_of(const std::vector<Step>& steps) {
  Moments moments;
  for (const Step& step : steps) moments.mean += step / static_cast<double>(steps.size());
  for (const Step& step : steps) {
    moments.covariance +=
        (step - moments.mean) * (step - moments.mean).transpose() / (static_cast<double>(steps.size()) - 1.0);
  }
  return moments;
}

constexpr int kDraws = 4000;

Moments moments_of_draws(StepProposals& proposals) {
  std::mt19937_64 random(1);
  std::vector<Step> steps;
  for (int i = 0; i < kDraws; ++i) steps.push_back(proposals.draw(random));
  return moments_of(steps);
}

/// So much may a mean and a variance of kDraws draws be off: five standard errors.
double tolerance_of_mean(double variance) {
  return 5.0 * std::sqrt(variance / kDraws);
}
double tolerance_of_variance(double variance) {
  return 5.0 * variance * std::sqrt(2.0 / kDraws);
}

void expect_isotropic(const Moments& moments, double deviation) {
  const double variance = deviation * deviation;
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(moments.mean[i], 0.0, tolerance_of_mean(variance));
    for (int j = 0; j < 3; ++j)
      EXPECT_NEAR(moments.covariance(i, j), i == j ? variance : 0.0, tolerance_of_variance(variance));
  }
}

/// Steps that lead far along one direction, and spread differently along each axis.
std::vector<Step> leading_steps(int count) {
  std::mt19937 random(2);
  std::normal_distribution<double> normal;
  std::vector<Step> steps;
  for (int i = 0; i < count; ++i) {
    const double along = normal(random), across = normal(random);
    steps.push_back({20.0 + 4.0 * along + across, -12.0 + 2.0 * along, 1.0 + 0.7 * across + normal(random)});
  }
  return steps;
}

TEST(StepProposals, BeginWithTheFirstStepInAllDirections) {
  RandomWalkOptions options;
  options.first_step = 3.0;
  StepProposals proposals(options);
  expect_isotropic(moments_of_draws(proposals), 3.0);
  for (const Step& step : leading_steps(3)) proposals.learn(step);  // too few for a covariance
  expect_isotropic(moments_of_draws(proposals), 3.0);
}

TEST(StepProposals, HaveTheMeanAndTheCovarianceOfTheLastAcceptedSteps) {
  RandomWalkOptions options;
  options.memory = 7;
  options.smallest_step = 1e-3;
  options.largest_step = 1e3;
  for (const int count : {4, 7, 30}) {
    StepProposals proposals(options);
    std::vector<Step> steps = leading_steps(count);
    for (const Step& step : steps) proposals.learn(step);
    steps.erase(steps.begin(), steps.end() - std::min(count, 7));
    const Moments learnt = moments_of(steps), drawn = moments_of_draws(proposals);
    for (int i = 0; i < 3; ++i) {
      EXPECT_NEAR(drawn.mean[i], learnt.mean[i], tolerance_of_mean(learnt.covariance(i, i))) << count;
      for (int j = 0; j < 3; ++j) {
        const double scale = std::sqrt(learnt.covariance(i, i) * learnt.covariance(j, j));
        EXPECT_NEAR(drawn.covariance(i, j), learnt.covariance(i, j), tolerance_of_variance(scale))
            << count << " " << i << " " << j;
      }
    }
  }
}

TEST(StepProposals, AreHeldBetweenTheSmallestAndTheLargestStep) {
  RandomWalkOptions options;
  options.smallest_step = 0.5;
  options.largest_step = 8.0;
  StepProposals same(options), wild(options);
  for (int i = 0; i < 10; ++i) {
    same.learn({6.0, 0.0, 0.0});  // a covariance of zero
    wild.learn((i % 2 == 0 ? 100.0 : -100.0) * Step::Unit(i % 3));
  }
  const Moments smallest = moments_of_draws(same), largest = moments_of_draws(wild);
  EXPECT_NEAR(smallest.mean.x(), 6.0, tolerance_of_mean(0.25));
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(smallest.covariance(i, i), 0.25, tolerance_of_variance(0.25));
    EXPECT_NEAR(largest.covariance(i, i), 64.0, tolerance_of_variance(64.0));
  }
}

TEST(StepProposals, AreHalvedAfterEveryHundredRefusalsAndStartAgain) {
  RandomWalkOptions options;
  options.first_step = 2.0;
  options.smallest_step = 0.5;
  StepProposals proposals(options);
  for (const double deviation : {2.0, 1.0, 0.5}) {
    expect_isotropic(moments_of_draws(proposals), deviation);
    for (int i = 0; i < 99; ++i) EXPECT_FALSE(proposals.learn_refusal()) << deviation;
    expect_isotropic(moments_of_draws(proposals), deviation);
    // The next halving would fall below the smallest step.
    EXPECT_EQ(proposals.learn_refusal(), deviation == 0.5);
  }
  expect_isotropic(moments_of_draws(proposals), 2.0);
}

TEST(StepProposals, RefusalsTakeTheMeanAwayAndAnAcceptedStepGivesTheSizeBack) {
  RandomWalkOptions options;
  StepProposals proposals(options);
  const auto expect = [&](double mean, double variance_of_turns) {
    const Moments drawn = moments_of_draws(proposals);
    const double variance = std::pow(options.smallest_step, 2);  // of equal steps
    EXPECT_NEAR(drawn.mean.x(), mean, tolerance_of_mean(variance));
    EXPECT_NEAR(drawn.covariance(2, 2), variance_of_turns, tolerance_of_variance(variance_of_turns));
  };
  for (int i = 0; i < 4; ++i) proposals.learn({5.0, 0.0, i % 2 == 0 ? 2.0 : -2.0});
  for (int i = 0; i < 50; ++i) proposals.learn_refusal();
  expect(5.0, 16.0 / 3.0);
  for (int i = 0; i < 50; ++i) proposals.learn_refusal();
  expect(0.0, 4.0 / 3.0);  // half of the deviation
  proposals.learn({5.0, 0.0, 2.0});
  expect(5.0, 4.8);                                                      // of 2, -2, 2, -2, 2
  for (int i = 0; i < 99; ++i) EXPECT_FALSE(proposals.learn_refusal());  // counted anew
  expect(5.0, 4.8);
}

TEST(StepProposals, StartAnewAsIfNothingHadBeenLearnt) {
  RandomWalkOptions options;
  options.first_step = 2.0;
  StepProposals proposals(options);
  for (const Step& step : leading_steps(9)) proposals.learn(step);
  for (int i = 0; i < 150; ++i) proposals.learn_refusal();
  proposals.start_anew();
  expect_isotropic(moments_of_draws(proposals), 2.0);
  for (const Step& step : leading_steps(3)) proposals.learn(step);
  expect_isotropic(moments_of_draws(proposals), 2.0);
  for (int i = 0; i < 99; ++i) EXPECT_FALSE(proposals.learn_refusal());
  expect_isotropic(moments_of_draws(proposals), 2.0);
}

}  // namespace
}  // namespace gridmerge::internal
