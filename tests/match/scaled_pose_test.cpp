// SPDX-License-Identifier: Apache-2.0
#include "match/scaled_pose.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "gridmerge/match/match_result.hpp"
#include "support/building.hpp"

namespace gridmerge {

using namespace internal;
namespace {

ScaledPose any_pose() {
  return {{*rc::gen::inRange(-500, 500) / 10.0, *rc::gen::inRange(-500, 500) / 10.0,
           *rc::gen::inRange(-314, 314) / 100.0},
          *rc::gen::inRange(20, 500) / 100.0};
}

Point2 any_point() {
  return {*rc::gen::inRange(-300, 300) / 10.0, *rc::gen::inRange(-300, 300) / 10.0};
}

double apart(const Point2& a, const Point2& b) {
  return std::hypot(a.x - b.x, a.y - b.y);
}

RC_GTEST_PROP(ScaledPose, AProductActsAsOneAfterTheOther, ()) {
  const ScaledPose a = any_pose(), b = any_pose();
  const Point2 p = any_point();
  RC_ASSERT(apart((a * b) * p, a * (b * p)) < 1e-8);
}

RC_GTEST_PROP(ScaledPose, TheInverseTakesBack, ()) {
  const ScaledPose a = any_pose();
  const Point2 p = any_point();
  RC_ASSERT(apart(inverse(a) * (a * p), p) < 1e-8);
}

RC_GTEST_PROP(ScaledPose, DisplacementIsThatOfPointsAboutTheCentre, ()) {
  const ScaledPose a = any_pose(), b = any_pose();
  const Point2 centre = any_point();
  const double radius = *rc::gen::inRange(1, 100) / 10.0;
  double sum = 0.0;
  constexpr int kPoints = 12;
  for (int i = 0; i < kPoints; ++i) {
    const double angle = 6.283185307179586 * i / kPoints;
    const Point2 p{centre.x + radius * std::cos(angle), centre.y + radius * std::sin(angle)};
    sum += std::pow(apart(a * p, b * p), 2);
  }
  RC_ASSERT(std::abs(displacement(centre, radius, a, b) - std::sqrt(sum / kPoints)) < 1e-8);
}

TEST(ScaledPose, OfScaleOneIsRigid) {
  const SE2 T{3.0, -2.0, 0.7};
  const Point2 p{1.5, 4.0};
  EXPECT_EQ((ScaledPose{T, 1.0} * p), T * p);
  EXPECT_NEAR(displacement({1.0, 2.0}, 5.0, {T, 1.0}, {T, 1.0}), 0.0, 1e-6);
}

TEST(ScaledPose, AnInverseResultTakesFixedPointsToMovingOnes) {
  MatchResult result;
  result.T_fixed_moving = {3.0, -2.0, 0.7};
  result.scale = 1.7;
  result.hypotheses = {{result.T_fixed_moving, 5.0, 0.5, {}, 1.7}};
  const Point2 p{4.0, -1.0};
  const Point2 there = ScaledPose{result.T_fixed_moving, result.scale} * p;
  const MatchResult inverted = inverse(result);
  EXPECT_NEAR(apart(ScaledPose{inverted.T_fixed_moving, inverted.scale} * there, p), 0.0, 1e-12);
  EXPECT_EQ(inverted.hypotheses[0].scale, inverted.scale);
  EXPECT_EQ(inverted.hypotheses[0].T_fixed_moving, inverted.T_fixed_moving);
}

TEST(Scaled, DrawsAMapLargerAboutItsFramesOrigin) {
  OccupancyGrid map = make_grid(4, 3, 0.1, {2.0, -1.0, 0.3});
  const OccupancyGrid larger = scaled(map, 1.5);
  EXPECT_DOUBLE_EQ(larger.resolution, 0.15);
  const Point2 corner = map.origin * Point2{0.4, 0.3}, larger_corner = larger.origin * Point2{0.6, 0.45};
  EXPECT_NEAR(larger_corner.x, 1.5 * corner.x, 1e-12);
  EXPECT_NEAR(larger_corner.y, 1.5 * corner.y, 1e-12);
}

TEST(Scaled, IsAMapWhereItIsScalable) {
  const auto is_a_map = [](const OccupancyGrid& map) {
    try {
      validate(map);
    } catch (const std::invalid_argument&) {
      return false;
    }
    return true;
  };
  for (const double resolution : {kMinResolution, 0.05, kMaxResolution}) {
    for (const double x : {0.0, -7.0, kMaxOrigin}) {
      const OccupancyGrid map = make_grid(2, 2, resolution, {0.5 * x, x, 0.3});
      for (const double factor : {0.01, 0.5, 1.0, 2.0, 2.5, 40.0})
        EXPECT_EQ(is_scalable(map, factor), is_a_map(scaled(map, factor))) << resolution << x << factor;
    }
  }
}

/// A building on itself, drawn a little smaller.
TEST(Climb, FindsTheScaleAndStaysInItsBounds) {
  const OccupancyGrid building = test::draw_building(1);
  const LikelihoodField fixed = make_likelihood_field(building, 0.1);
  const LikelihoodField moving = make_likelihood_field(scaled(building, 0.98), 0.1);
  const WallEvidence evidence(fixed, moving, std::numeric_limits<std::size_t>::max());
  const PoseMetric metric = make_pose_metric(moving);
  const ScoredScaledPose free = climb(evidence, metric, {{1.0, 1.0, 0.01}, 1.0}, 4.0, 0.125, 0.9, 1.1);
  EXPECT_NEAR(free.pose.scale, 1.0 / 0.98, 0.004);
  EXPECT_GT(free.evidence.score, evidence({1.0, 1.0, 0.01}).score);
  const ScoredScaledPose bound = climb(evidence, metric, {{1.0, 1.0, 0.01}, 1.0}, 4.0, 0.125, 0.99, 1.01);
  EXPECT_LE(bound.pose.scale, 1.01);
  EXPECT_GE(bound.pose.scale, 1.0);
  EXPECT_LE(bound.evidence.score, free.evidence.score);
}

// Turned by one step about where the pivot is drawn, far from the origin, it is turned back by one step.
TEST(Climb, TurnsAboutWhereThePivotIsDrawn) {
  const OccupancyGrid building = test::draw_building(1);
  constexpr double kCell = 0.1, kScale = 2.0, kStep = 8.0;
  const LikelihoodField fixed = make_likelihood_field(scaled(building, kScale), kCell);
  const LikelihoodField moving = make_likelihood_field(building, kCell);
  const WallEvidence evidence(fixed, moving, std::numeric_limits<std::size_t>::max());
  const PoseMetric metric = make_pose_metric(moving);
  const SE2 &f = fixed.T_map_grid, &m = moving.T_map_grid;
  const SE2 T{(kScale * m.x - f.x) / kCell, (kScale * m.y - f.y) / kCell, 0.0};
  const PoseMetric drawn{{kScale * metric.pivot.x, kScale * metric.pivot.y}, metric.radius};
  for (const double turn : {kStep, -kStep}) {
    const SE2 turned = drawn.moved(T, 0.0, 0.0, turn / metric.radius);
    const ScoredScaledPose found =
        climb(evidence, metric, {turned, kScale}, kStep, kStep, kScale - 0.01, kScale + 0.01);
    EXPECT_NEAR(found.pose.T.x, T.x, 1e-9);
    EXPECT_NEAR(found.pose.T.y, T.y, 1e-9);
    EXPECT_NEAR(found.pose.T.theta, 0.0, 1e-12);
    EXPECT_EQ(found.pose.scale, kScale);
    EXPECT_EQ(found.evidence.score, evidence(found.pose.T, 0.0, kScale).score);
  }
}

}  // namespace
}  // namespace gridmerge
