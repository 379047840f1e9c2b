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

TEST(Walkers, AreAsManyAndAsThickAsTheySay) {
  const FloorPlan plan(room(), 0.2);
  Random random(11);
  int met = 0;
  constexpr int kTries = 40, kBeamsEach = 500;
  for (int i = 0; i < kTries; ++i) {
    const Walkers walkers(plan, 15.0, random.fork());
    for (int k = 0; k < kBeamsEach; ++k) {
      const double x = random.uniform(2.0, 18.0);
      const double y = random.uniform(2.0, 18.0);
      const double angle = random.uniform(0.0, 2.0 * std::numbers::pi);
      met += std::isinf(walkers.distance_to({x, y}, {std::cos(angle), std::sin(angle)}, 1.0)) ? 0 : 1;
    }
  }
  // A beam of 1 m meets a disc of 0.2 m whose middle is in 0.4 m^2 about it: 15 of them on every 150 m^2.
  EXPECT_NEAR(met / static_cast<double>(kTries * kBeamsEach), 0.4 * 15.0 / 150.0, 0.006);
}

TEST(Visit, ScattersAsMuchAsItSays) {
  const FloorPlan plan(room(), 0.2);
  const int start = plan.cell_at({10.05, 10.05});
  // A chair is three feet of four edges, a pillar has eight, a box four: of four pieces two are boxes.
  for (const double clutter : {0.5, 1.0, 2.0}) {
    double edges = 0.0;
    constexpr int kVisits = 40;
    Random random(13);
    for (int i = 0; i < kVisits; ++i) {
      const Visit visit = make_visit(room(), plan, 0.2, start, clutter, random);
      edges += static_cast<double>(visit.caster.edges().size() - 4) / kVisits;
      EXPECT_TRUE(visit.plan.is_free(start));
      EXPECT_GT(visit.plan.count_free(), 0.85 * plan.count_free());
      EXPECT_EQ(visit.plan.cells(), plan.cells());
    }
    const double pieces = clutter * 19.6 * 19.6 / 25.0;
    EXPECT_NEAR(edges, 7.0 * pieces, 0.12 * 7.0 * pieces) << clutter;
  }
}

TEST(Visit, LeavesAFloorThatIsTooNarrowAlone) {
  // A corridor of 1.2 m: whatever stands in it is in somebody's way.
  const std::vector<Edge> corridor{{{0.0, 0.0}, {20.0, 0.0}, 1.0},
                                   {{20.0, 0.0}, {20.0, 1.2}, 1.0},
                                   {{20.0, 1.2}, {0.0, 1.2}, 1.0},
                                   {{0.0, 1.2}, {0.0, 0.0}, 1.0}};
  const FloorPlan plan(corridor, 0.2);
  Random random(17);
  const Visit visit = make_visit(corridor, plan, 0.2, plan.free_cells().front(), 5.0, random);
  EXPECT_EQ(visit.caster.edges().size(), corridor.size());
  EXPECT_EQ(visit.plan.count_free(), plan.count_free());
}

}  // namespace
}  // namespace gridmerge
