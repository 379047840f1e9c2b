// SPDX-License-Identifier: Apache-2.0
#include "simulate/drift.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <iterator>
#include <numbers>
#include <vector>

namespace gridmerge::internal {
namespace {

/// Straight ahead along +x, every 0.3 m.
std::vector<SE2> ahead(double metres) {
  std::vector<SE2> path;
  for (int i = 0; 0.3 * i <= metres; ++i) path.push_back({0.3 * i, 0.0, 0.0});
  return path;
}

/// By how much the last belief is off.
SE2 error_after(const std::vector<SE2>& path, double drift, std::uint64_t seed) {
  DriftingPose robot(drift, Random(seed));
  SE2 believed;
  for (const SE2& pose : path) believed = robot.follow(pose);
  return {believed.x - path.back().x, believed.y - path.back().y,
          normalize_angle(believed.theta - path.back().theta)};
}

struct Spread {
  double x, y, theta;  // root mean squares
};

Spread spread_after(const std::vector<SE2>& path, double drift) {
  constexpr int kRobots = 400;
  Spread sums{0.0, 0.0, 0.0};
  for (std::uint64_t seed = 0; seed < kRobots; ++seed) {
    const SE2 error = error_after(path, drift, seed);
    sums.x += error.x * error.x / kRobots;
    sums.y += error.y * error.y / kRobots;
    sums.theta += error.theta * error.theta / kRobots;
  }
  return {std::sqrt(sums.x), std::sqrt(sums.y), std::sqrt(sums.theta)};
}

TEST(DriftingPose, TheFirstPoseIsRight) {
  DriftingPose robot(3.0, Random(1));
  const SE2 start{4.0, -2.0, 1.0};
  EXPECT_EQ(robot.follow(start), start);
}

TEST(DriftingPose, WithoutDriftOnlyScanMatchingIsOff) {
  const Spread spread = spread_after(ahead(60.0), 0.0);
  // Below a centimetre, and a tenth of a degree, however long the way was.
  EXPECT_NEAR(spread.x, 0.008, 0.0012);
  EXPECT_NEAR(spread.y, 0.008, 0.0012);
  EXPECT_NEAR(spread.theta, 0.002, 0.0003);
}

TEST(DriftingPose, ErrorsGrowWithTheWayAsARandomWalkOfTheHeadingDoes) {
  // A bias of the heading with a standard deviation of b that lasts for a way w makes, after a way s, a
  // variance of 2 b^2 (w s - w^2 (1 - exp(-s / w))) of the heading, if it is b from the start; it begins at
  // 0, which takes b^2 w^2 (1 - exp(-s / w))^2 from it.
  const auto heading = [](double s) {
    const double b = 0.0022, w = 8.0, gone = 1.0 - std::exp(-s / w);
    return std::sqrt(2.0 * b * b * (w * s - w * w * gone) - b * b * w * w * gone * gone);
  };
  double last = 0.0;
  for (const double way : {15.0, 30.0, 60.0}) {
    const Spread spread = spread_after(ahead(way), 1.0);
    EXPECT_NEAR(spread.theta, heading(way), 0.12 * heading(way)) << way;
    // Along the way, it takes one metre in a hundred too many or too few.
    EXPECT_NEAR(spread.x, 0.01 * way, 0.2 * 0.01 * way) << way;
    EXPECT_GT(spread.y, last) << way;
    last = spread.y;
  }
  // Sideways, decimetres over a floor.
  EXPECT_GT(last, 0.5);
  EXPECT_LT(last, 3.0);
}

TEST(DriftingPose, MoreDriftBendsMoreInProportion) {
  const Spread one = spread_after(ahead(40.0), 1.0), two = spread_after(ahead(40.0), 2.0);
  EXPECT_NEAR(two.theta, 2.0 * one.theta, 0.05 * two.theta);
  EXPECT_NEAR(two.y, 2.0 * one.y, 0.1 * two.y);
}

TEST(DriftingPose, TurningCosts) {
  std::vector<SE2> turns(1);
  for (int i = 1; i <= 100; ++i) turns.push_back({0.0, 0.0, normalize_angle(i * 0.5)});
  // Each turn by half a radian is off by one part in a hundred; a hundred of them are independent.
  EXPECT_NEAR(spread_after(turns, 1.0).theta, 0.005 * std::sqrt(100.0), 0.008);
}

TEST(DriftingPose, IsPulledBackWhereItWasBefore) {
  // Away and back, and then to and fro over the places where its map was right.
  std::vector<SE2> away = ahead(40.0);
  for (int i = static_cast<int>(away.size()) - 2; i >= 0; --i)
    away.push_back({0.3 * i, 0.0, std::numbers::pi});
  const Spread back = spread_after(away, 1.0);
  const Spread as_far = spread_after(ahead(80.0), 1.0);
  EXPECT_LT(back.x, 0.2 * as_far.x);
  EXPECT_LT(back.y, 0.2 * as_far.y);
  EXPECT_LT(back.theta, 0.4 * as_far.theta);
}

// What these seeds have bent so far: out, to and fro in a room, and back by the way it came.
TEST(DriftingPose, EveryCompilerBendsTheSame) {
  std::vector<SE2> path = ahead(12.0);
  for (int i = 0; i < 40; ++i) path.push_back({12.0, 0.3 * i, 0.5 * std::numbers::pi});
  for (int i = 39; i >= 0; --i) path.push_back({12.0, 0.3 * i, -0.5 * std::numbers::pi});
  for (int i = 40; i >= 0; --i) path.push_back({0.3 * i, 0.0, std::numbers::pi});
  const SE2 bent[] = {{0.046613978943, 0.022093988290, 0.006730557520},
                      {0.006499551101, -0.031799606520, -0.008451141020},
                      {0.014575777492, 0.025078070888, -0.014950810677}};
  for (std::uint64_t seed = 0; seed < std::size(bent); ++seed) {
    const SE2 error = error_after(path, 2.0, seed);
    EXPECT_NEAR(error.x, bent[seed].x, 1e-9) << seed;
    EXPECT_NEAR(error.y, bent[seed].y, 1e-9) << seed;
    EXPECT_NEAR(error.theta, bent[seed].theta, 1e-9) << seed;
  }
}

}  // namespace
}  // namespace gridmerge::internal
