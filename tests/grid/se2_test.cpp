// SPDX-License-Identifier: Apache-2.0
#include "gridmerge/grid/se2.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <numbers>

#include "grid/generators.hpp"

namespace gridmerge {
namespace {

using std::numbers::pi;

constexpr double kTolerance = 1e-11;  // of coordinates of some hundred metres

bool near(const Point2& a, const Point2& b) {
  return std::hypot(a.x - b.x, a.y - b.y) < kTolerance;
}

bool near(const SE2& a, const SE2& b) {
  return near(Point2{a.x, a.y}, Point2{b.x, b.y}) &&
         std::abs(normalize_angle(a.theta - b.theta)) < kTolerance;
}

TEST(NormalizeAngle, KeepsTheHalfOpenRange) {
  EXPECT_EQ(normalize_angle(pi), pi);
  EXPECT_EQ(normalize_angle(-pi), pi);
  EXPECT_EQ(normalize_angle(0.0), 0.0);
  EXPECT_EQ(normalize_angle(-3.0), -3.0);
  EXPECT_DOUBLE_EQ(normalize_angle(1.5 * pi), -0.5 * pi);
  EXPECT_DOUBLE_EQ(normalize_angle(-1.5 * pi), 0.5 * pi);
  EXPECT_DOUBLE_EQ(normalize_angle(2.0 * pi + 0.25), 0.25);
}

RC_GTEST_PROP(NormalizeAngle, IsTheSameDirectionWithinRange, ()) {
  const double angle = *between(-1000.0, 1000.0);
  const double normal = normalize_angle(angle);
  RC_ASSERT(normal > -pi);
  RC_ASSERT(normal <= pi);
  RC_ASSERT(std::abs(std::sin(normal) - std::sin(angle)) < kTolerance);
  RC_ASSERT(std::abs(std::cos(normal) - std::cos(angle)) < kTolerance);
  RC_ASSERT(normalize_angle(normal) == normal);
}

TEST(Se2, RotatesCounterClockwiseThenTranslates) {
  const Point2 p = SE2{1.0, 2.0, pi / 2} * Point2{3.0, 0.0};
  EXPECT_NEAR(p.x, 1.0, kTolerance);
  EXPECT_NEAR(p.y, 5.0, kTolerance);
}

TEST(Se2, CompositionKeepsTheAngleInRange) {
  EXPECT_NEAR((SE2{0, 0, 3.0} * SE2{0, 0, 1.0}).theta, 4.0 - 2.0 * pi, kTolerance);
  EXPECT_EQ((SE2{0, 0, pi / 2} * SE2{0, 0, pi / 2}).theta, pi);
  EXPECT_EQ(inverse(SE2{0, 0, pi}).theta, pi);
}

RC_GTEST_PROP(Se2, InverseUndoes, (const SE2& T)) {
  RC_ASSERT(near(T * inverse(T), SE2{}));
  RC_ASSERT(near(inverse(T) * T, SE2{}));
  RC_ASSERT(near(inverse(inverse(T)), T));
}

RC_GTEST_PROP(Se2, CompositionAppliesTheRightHandSideFirst, (const SE2& T_a_b, const SE2& T_b_c)) {
  const Point2 p{*between(-100.0, 100.0), *between(-100.0, 100.0)};
  RC_ASSERT(near((T_a_b * T_b_c) * p, T_a_b * (T_b_c * p)));
}

RC_GTEST_PROP(Se2, CompositionIsAssociative, (const SE2& a, const SE2& b, const SE2& c)) {
  RC_ASSERT(near((a * b) * c, a * (b * c)));
}

RC_GTEST_PROP(ManyPointsTransform, ProductsAndInversesAreThoseOfTheSe2s,
              (const SE2& T_a_b, const SE2& T_b_c)) {
  const ManyPointsTransform product = ManyPointsTransform(T_a_b) * ManyPointsTransform(T_b_c);
  const ManyPointsTransform back = product.inverse();
  const SE2 expected = T_a_b * T_b_c;
  for (const Point2& p : {Point2{0.0, 0.0}, Point2{3.0, -7.0}}) {
    RC_ASSERT(near(product * p, expected * p));
    RC_ASSERT(near(back * p, inverse(expected) * p));
  }
  RC_ASSERT(std::abs(product.cos() - std::cos(expected.theta)) < kTolerance);
  RC_ASSERT(std::abs(product.sin() - std::sin(expected.theta)) < kTolerance);
}

RC_GTEST_PROP(Se2, KeepsDistances, (const SE2& T)) {
  const Point2 p{*between(-100.0, 100.0), *between(-100.0, 100.0)};
  const Point2 q{*between(-100.0, 100.0), *between(-100.0, 100.0)};
  const Point2 Tp = T * p, Tq = T * q;
  RC_ASSERT(std::abs(std::hypot(Tp.x - Tq.x, Tp.y - Tq.y) - std::hypot(p.x - q.x, p.y - q.y)) < kTolerance);
}

}  // namespace
}  // namespace gridmerge
