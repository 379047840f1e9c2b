// SPDX-License-Identifier: Apache-2.0
#include "simulate/rigid_fit.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "simulate/random.hpp"

namespace gridmerge {

using namespace internal;
namespace {

double rms(const std::vector<PointPair>& points, const SE2& T_a_b) {
  double sum = 0.0;
  for (const PointPair& point : points) {
    const Point2 at = T_a_b * point.in_b;
    sum += std::pow(at.x - point.in_a.x, 2) + std::pow(at.y - point.in_a.y, 2);
  }
  return std::sqrt(sum / static_cast<double>(points.size()));
}

TEST(RigidFit, FindsATransformAndNothingNearIsBetterWithNoise) {
  Random random(1);
  for (int run = 0; run < 50; ++run) {
    const SE2 truth{random.uniform(-9.0, 9.0), random.uniform(-9.0, 9.0), random.uniform(-3.1, 3.1)};
    const double noise = run % 2 == 0 ? 0.0 : 0.3;
    std::vector<PointPair> points;
    for (int i = 0; i < 30; ++i) {
      const Point2 b{random.uniform(-5.0, 5.0), random.uniform(-5.0, 5.0)};
      const Point2 a = truth * b;
      points.push_back({{a.x + random.normal(noise), a.y + random.normal(noise)}, b});
    }
    const RigidFit fit = fit_rigid(points);
    EXPECT_NEAR(fit.rms, rms(points, fit.T_a_b), 1e-12);
    if (noise == 0.0) {
      EXPECT_NEAR(fit.T_a_b.x, truth.x, 1e-9);
      EXPECT_NEAR(fit.T_a_b.y, truth.y, 1e-9);
      EXPECT_NEAR(normalize_angle(fit.T_a_b.theta - truth.theta), 0.0, 1e-9);
    }
    for (int i = 0; i < 20; ++i) {
      const SE2 other{fit.T_a_b.x + random.normal(0.05), fit.T_a_b.y + random.normal(0.05),
                      fit.T_a_b.theta + random.normal(0.02)};
      EXPECT_GE(rms(points, other), fit.rms);
    }
  }
  EXPECT_EQ(fit_rigid({}).T_a_b, SE2{});
}

}  // namespace
}  // namespace gridmerge
