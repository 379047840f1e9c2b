// SPDX-License-Identifier: Apache-2.0
#include "simulate/ray_caster.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>

#include "simulate/random.hpp"

namespace gridmerge {

using namespace internal;
namespace {

Point2 direction(double angle) {
  return {std::cos(angle), std::sin(angle)};
}

TEST(RayCaster, MeetsWhatLookingAtEveryEdgeMeets) {
  Random random(1);
  std::vector<Edge> edges;
  for (int i = 0; i < 120; ++i) {
    const Point2 a{random.uniform(-10.0, 10.0), random.uniform(-10.0, 10.0)};
    const Point2 u = direction(random.uniform(0.0, 6.3));
    const double length = i % 4 == 0 ? random.uniform(5.0, 15.0) : random.uniform(0.05, 2.0);
    edges.push_back({a, {a.x + length * u.x, a.y + length * u.y}, random.uniform()});
  }
  const RayCaster caster(edges);
  // Beams that keep to one row or column of buckets, too.
  constexpr std::array<Point2, 4> kAlongAxes{{{1.0, 0.0}, {-1.0, 0.0}, {0.0, 1.0}, {0.0, -1.0}}};
  int met = 0;
  for (int i = 0; i < 5000; ++i) {
    const Point2 from{random.uniform(-14.0, 14.0), random.uniform(-14.0, 14.0)};
    const Point2 anywhere = direction(random.uniform(0.0, 6.3));
    const Point2 u = i % 5 == 0 ? kAlongAxes[static_cast<std::size_t>(i / 5) % 4] : anywhere;
    const double range = random.uniform(0.5, 12.0);
    const double beyond = i % 3 == 0 ? random.uniform(0.0, 3.0) : 0.0;
    Hit expected;
    for (const Edge& edge : edges) {
      const double distance = distance_to(edge, from, u);
      if (distance > beyond && distance <= range && distance < expected.range)
        expected = {distance, edge.echo};
    }
    const Hit found = caster.cast(from, u, range, beyond);
    ASSERT_EQ(found.range, expected.range) << i;
    ASSERT_EQ(found.echo, expected.echo) << i;
    met += std::isinf(expected.range) ? 0 : 1;
  }
  EXPECT_GT(met, 1000);
}

TEST(RayCaster, BeamsAlongTheAxesAndOnBordersOfBucketsMeetWalls) {
  const RayCaster caster({{{-5.0, 3.0}, {5.0, 3.0}, 1.0}, {{4.0, -5.0}, {4.0, 5.0}, 0.5}});
  EXPECT_DOUBLE_EQ(caster.cast({0.0, 0.0}, {0.0, 1.0}, 10.0).range, 3.0);
  EXPECT_DOUBLE_EQ(caster.cast({0.0, 0.0}, {1.0, 0.0}, 10.0).range, 4.0);
  EXPECT_DOUBLE_EQ(caster.cast({0.0, 0.0}, {1.0, 0.0}, 10.0).echo, 0.5);
  EXPECT_TRUE(std::isinf(caster.cast({0.0, 0.0}, {-1.0, 0.0}, 10.0).range));
  EXPECT_TRUE(std::isinf(caster.cast({0.0, 0.0}, {0.0, 1.0}, 2.9).range));
  EXPECT_TRUE(std::isinf(RayCaster({}).cast({0.0, 0.0}, {0.0, 1.0}, 10.0).range));
}

}  // namespace
}  // namespace gridmerge
