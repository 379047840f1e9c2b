// SPDX-License-Identifier: Apache-2.0
#include "merge/map_extent.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <vector>

namespace gridmerge {

using namespace internal;
namespace {

double real_between(int low, int high) {
  return *rc::gen::inRange(low * 1000, high * 1000) / 1000.0;
}

SE2 any_pose() {
  return {real_between(-50, 50), real_between(-50, 50), normalize_angle(real_between(-4, 4))};
}

std::vector<Point2> any_points() {
  std::vector<Point2> points(*rc::gen::inRange<std::size_t>(1, 20));
  for (Point2& point : points) point = {real_between(-20, 20), real_between(-20, 20)};
  return points;
}

MapExtent extent_of(const std::vector<Point2>& points) {
  const double count = static_cast<double>(points.size());
  MapExtent extent;
  for (const Point2& p : points)
    extent.centre = {extent.centre.x + p.x / count, extent.centre.y + p.y / count};
  double squares = 0.0;
  for (const Point2& p : points)
    squares += std::pow(p.x - extent.centre.x, 2) + std::pow(p.y - extent.centre.y, 2);
  extent.radius = std::sqrt(squares / count);
  return extent;
}

RC_GTEST_PROP(MapExtent, DisplacementIsThatOfAllPoints, ()) {
  const std::vector<Point2> points = any_points();
  const SE2 a = any_pose(), b = any_pose();
  double squares = 0.0;
  for (const Point2& point : points) {
    const Point2 at_a = a * point, at_b = b * point;
    squares += std::pow(at_a.x - at_b.x, 2) + std::pow(at_a.y - at_b.y, 2);
  }
  const double expected = std::sqrt(squares / static_cast<double>(points.size()));
  RC_ASSERT(std::abs(displacement(extent_of(points), a, b) - expected) <= 1e-6 * (1.0 + expected));
}

RC_GTEST_PROP(MapExtent, DifferenceDoesNotDependOnWhichMapMoves, ()) {
  const MapExtent a = extent_of(any_points()), b = extent_of(any_points());
  const SE2 T = any_pose(), T_other = any_pose();
  const double forth = difference(a, b, T, T_other);
  const double back = difference(b, a, inverse(T), inverse(T_other));
  RC_ASSERT(std::abs(forth - back) <= 1e-6 * (1.0 + forth));
  RC_ASSERT(forth <= displacement(b, T, T_other));
}

TEST(MapExtent, LargerMapsMayDifferMore) {
  const MapExtent small{{}, 2.0, 5.0}, large{{}, 20.0, 50.0};
  EXPECT_EQ(agreement_tolerance(small, small), 0.5);
  EXPECT_NEAR(agreement_tolerance(small, large), 2.25, 1e-12);
  EXPECT_EQ(agreement_tolerance(small, large), agreement_tolerance(large, small));
}

}  // namespace
}  // namespace gridmerge
