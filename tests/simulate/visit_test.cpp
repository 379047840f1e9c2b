// SPDX-License-Identifier: Apache-2.0
#include "simulate/visit.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

namespace gridmerge {

using namespace internal;
namespace {

/// A square room of 20 m.
std::vector<Edge> room() {
  return {{{0.0, 0.0}, {20.0, 0.0}, 1.0},
          {{20.0, 0.0}, {20.0, 20.0}, 1.0},
          {{20.0, 20.0}, {0.0, 20.0}, 1.0},
          {{0.0, 20.0}, {0.0, 0.0}, 1.0}};
}

constexpr int kBeams = 360;

/// What beams from the middle of the room meet of people.
std::vector<double> look(const Walkers& walkers) {
  std::vector<double> ranges;
  for (int i = 0; i < kBeams; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / kBeams;
    ranges.push_back(walkers.distance_to({10.0, 10.0}, {std::cos(angle), std::sin(angle)}, 30.0));
  }
  return ranges;
}

TEST(Walkers, StayInTheRoomAndNeverStopForGood) {
  const FloorPlan plan(room(), 0.2);
  Walkers walkers(plan, 4.0, Random(5));
  int still = 0;
  for (int i = 0; i < 400; ++i) {
    const std::vector<double> before = look(walkers);
    int met = 0;
    for (int k = 0; k < kBeams; ++k) {
      if (std::isinf(before[k])) continue;
      ++met;
      const double angle = 2.0 * std::numbers::pi * k / kBeams;
      EXPECT_LE(std::abs(before[k] * std::cos(angle)), 10.0);
      EXPECT_LE(std::abs(before[k] * std::sin(angle)), 10.0);
    }
    ASSERT_GT(met, 0);
    walkers.walk();
    still += look(walkers) == before ? 1 : 0;
  }
  // A few turn at a wall at once now and then, but not all.
  EXPECT_LT(still, 10);
}

TEST(Walkers, AreNoneWhereThereIsNoClutter) {
  const FloorPlan plan(room(), 0.2);
  const Walkers walkers(plan, 0.0, Random(5));
  for (const double range : look(walkers)) EXPECT_TRUE(std::isinf(range));
}

TEST(Walkers, AreSeenOnlyAheadAndWithinRange) {
  const FloorPlan plan(room(), 0.2);
  const Walkers walkers(plan, 4.0, Random(7));
  const std::vector<double> ranges = look(walkers);
  for (int i = 0; i < kBeams; ++i) {
    if (std::isinf(ranges[i])) continue;
    const double angle = 2.0 * std::numbers::pi * i / kBeams;
    const Point2 u{std::cos(angle), std::sin(angle)};
    EXPECT_TRUE(std::isinf(walkers.distance_to({10.0, 10.0}, u, 0.99 * ranges[i])));
    // From nearer by a little, it is nearer by as much.
    const double step = 0.5 * ranges[i];
    EXPECT_NEAR(walkers.distance_to({10.0 + step * u.x, 10.0 + step * u.y}, u, 30.0), ranges[i] - step, 1e-9);
  }
}

}  // namespace
}  // namespace gridmerge
