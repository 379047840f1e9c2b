// SPDX-License-Identifier: Apache-2.0
#include "simulate/explore.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace gridmerge::internal {
namespace {

constexpr double kWholeTurn = 2.0 * std::numbers::pi;

void add_wall(std::vector<Edge>& edges, Point2 a, Point2 b) {
  edges.push_back({a, b, 1.0});
}

/// Two rooms of 6 m x 6 m side by side, and a door of 1 m between them.
std::vector<Edge> two_rooms() {
  std::vector<Edge> edges;
  add_wall(edges, {0.0, 0.0}, {12.0, 0.0});
  add_wall(edges, {12.0, 0.0}, {12.0, 6.0});
  add_wall(edges, {12.0, 6.0}, {0.0, 6.0});
  add_wall(edges, {0.0, 6.0}, {0.0, 0.0});
  add_wall(edges, {6.0, 0.0}, {6.0, 1.0});
  add_wall(edges, {6.0, 2.0}, {6.0, 6.0});
  return edges;
}

struct Floor {
  explicit Floor(std::vector<Edge> edges) : plan(edges, 0.2), caster(std::move(edges)) {}

  FloorPlan plan;
  RayCaster caster;
};

Errand errand_from(const Floor& floor, Point2 start) {
  Errand errand;
  errand.start = floor.plan.cell_at(start);
  errand.reach = 1e6;
  errand.longest_way = 1e6;
  return errand;
}

/// The share of the floor's cells where a robot can stand that were seen.
double share_seen(const Floor& floor, const SeenFloor& seen) {
  int count = 0;
  for (const int cell : floor.plan.free_cells()) count += seen.has_seen(cell) ? 1 : 0;
  return count / static_cast<double>(floor.plan.count_free());
}

double way_of(const std::vector<SE2>& poses) {
  double way = 0.0;
  for (std::size_t i = 1; i < poses.size(); ++i)
    way += std::hypot(poses[i].x - poses[i - 1].x, poses[i].y - poses[i - 1].y);
  return way;
}

TEST(SeenFloor, IsWhatASightLineReaches) {
  const Floor floor(two_rooms());
  SeenFloor seen(floor.plan);
  EXPECT_EQ(seen.count(), 0);
  const SE2 from{3.0, 3.0, 0.0};
  seen.look(floor.caster, from, 20.0, 20.0, kWholeTurn);
  for (const int cell : floor.plan.free_cells()) {
    const Point2 at = floor.plan.centre(cell);
    // Cells of the raster are 0.4 m wide, and rays end on walls: the rim is left out.
    if (at.x < 5.4) {
      EXPECT_TRUE(seen.has_seen(cell)) << at.x << ' ' << at.y;
    }
    // Through the door, from y = 1 to 2, a wedge: nothing above it.
    if (at.x > 7.0 && at.y > 2.5) {
      EXPECT_FALSE(seen.has_seen(cell)) << at.x << ' ' << at.y;
    }
  }
  // Nearer eyes see a disc.
  SeenFloor disc(floor.plan);
  disc.look(floor.caster, from, 2.0, 2.0, kWholeTurn);
  for (const int cell : floor.plan.free_cells()) {
    const Point2 at = floor.plan.centre(cell);
    const double away = std::hypot(at.x - from.x, at.y - from.y);
    if (away < 1.8) {
      EXPECT_TRUE(disc.has_seen(cell)) << away;
    }
    if (away > 2.6) {
      EXPECT_FALSE(disc.has_seen(cell)) << away;
    }
  }
  EXPECT_EQ(count_common(seen, disc), disc.count());
  EXPECT_NEAR(disc.count() * 0.16, std::numbers::pi * 4.0, 0.25 * std::numbers::pi * 4.0);
}

TEST(SeenFloor, ABeamWithoutAnEchoClearsLess) {
  const Floor floor(two_rooms());
  SeenFloor seen(floor.plan);
  // Walls are 3 m away: beams of 2.5 m meet none, and count as free for 1 m.
  seen.look(floor.caster, {3.0, 3.0, 0.0}, 2.5, 1.0, kWholeTurn);
  EXPECT_TRUE(seen.has_seen(floor.plan.cell_at({3.0, 3.85})));
  EXPECT_FALSE(seen.has_seen(floor.plan.cell_at({3.0, 4.6})));
}

TEST(SeenFloor, LooksAheadWithinItsField) {
  const Floor floor(two_rooms());
  SeenFloor seen(floor.plan);
  seen.look(floor.caster, {3.0, 3.0, 0.5 * std::numbers::pi}, 2.5, 2.5, 0.5 * std::numbers::pi);
  EXPECT_TRUE(seen.has_seen(floor.plan.cell_at({3.0, 5.0})));
  EXPECT_TRUE(seen.has_seen(floor.plan.cell_at({4.2, 4.6})));
  EXPECT_TRUE(seen.has_seen(floor.plan.cell_at({1.8, 4.6})));
  EXPECT_FALSE(seen.has_seen(floor.plan.cell_at({3.0, 1.0})));
  EXPECT_FALSE(seen.has_seen(floor.plan.cell_at({5.0, 3.0})));
  EXPECT_FALSE(seen.has_seen(floor.plan.cell_at({1.0, 3.0})));
}

TEST(Explore, SeesAllThatCanBeReached) {
  const Floor floor(two_rooms());
  for (const Point2 start : {Point2{3.05, 3.05}, Point2{0.55, 5.45}, Point2{11.05, 0.55}}) {
    const Exploration found = explore(floor.plan, floor.caster, errand_from(floor, start));
    EXPECT_GT(share_seen(floor, found.seen), 0.99);
    EXPECT_NEAR(found.poses.front().x, start.x, 0.051);
    EXPECT_NEAR(found.poses.front().y, start.y, 0.051);
    // It goes from room to room, and not often.
    EXPECT_GT(way_of(found.poses), 3.0);
    EXPECT_LT(way_of(found.poses), 60.0);
  }
}

TEST(Explore, ScansEverySoFarAndLooksWhereItGoes) {
  const Floor floor(two_rooms());
  Errand errand = errand_from(floor, {0.55, 5.45});
  errand.scan_every = 0.5;
  const Exploration found = explore(floor.plan, floor.caster, errand);
  ASSERT_GT(found.poses.size(), 5U);
  for (std::size_t i = 1; i < found.poses.size(); ++i) {
    const SE2 &a = found.poses[i - 1], &b = found.poses[i];
    const double step = std::hypot(b.x - a.x, b.y - a.y);
    const bool turns = std::abs(normalize_angle(b.theta - a.theta)) > 1.0;
    EXPECT_LT(step, 0.5 + 0.15) << i;
    if (!turns) {
      EXPECT_GT(step, 0.25) << i;
    }
    EXPECT_TRUE(floor.plan.is_free(floor.plan.cell_at({b.x, b.y}))) << i;
    // The way from scan to scan, which may bend.
    if (step > 0.3 && !turns) {
      EXPECT_LT(std::abs(normalize_angle(std::atan2(b.y - a.y, b.x - a.x) - b.theta)), 1.6) << i;
    }
  }
  errand.scan_every = 1.5;
  EXPECT_LT(explore(floor.plan, floor.caster, errand).poses.size(), found.poses.size());
}

TEST(Explore, StopsWhenItsWayIsLongEnough) {
  const Floor floor(two_rooms());
  Errand errand = errand_from(floor, {0.55, 5.45});
  errand.scan_every = 0.1;
  for (const double longest : {0.5, 2.0, 4.0}) {
    errand.longest_way = longest;
    const double way = way_of(explore(floor.plan, floor.caster, errand).poses);
    EXPECT_NEAR(way, longest, 0.3) << longest;
  }
}

TEST(Explore, StaysWithinItsReachAndAheadOfItsStart) {
  const Floor floor(two_rooms());
  Errand errand = errand_from(floor, {9.05, 3.05});
  errand.reach = 3.0;
  const Exploration near = explore(floor.plan, floor.caster, errand);
  for (const SE2& pose : near.poses) EXPECT_LT(std::hypot(pose.x - 9.05, pose.y - 3.05), 3.2);

  // With its eyes on a few metres, it has to go to see.
  errand.reach = 1e6;
  errand.sensor.range = 2.0;
  for (const double heading : {0.0, std::numbers::pi}) {
    errand.heading = heading;
    const Exploration found = explore(floor.plan, floor.caster, errand);
    EXPECT_EQ(found.poses.front().theta, heading);
    for (const SE2& pose : found.poses) EXPECT_GT((pose.x - 9.05) * std::cos(heading), -0.5);
    double farthest = 0.0;
    for (const SE2& pose : found.poses) farthest = std::max(farthest, (pose.x - 9.05) * std::cos(heading));
    EXPECT_GT(farthest, heading == 0.0 ? 1.0 : 6.0);
  }
}

TEST(Explore, TheRangeFinderDrawsNoMoreThanItReaches) {
  const Floor floor(two_rooms());
  Errand errand = errand_from(floor, {3.05, 3.05});
  errand.longest_way = 0.0;
  errand.sensor.field_of_view = std::numbers::pi;
  const Exploration found = explore(floor.plan, floor.caster, errand);
  ASSERT_EQ(found.poses.size(), 1U);
  // It looks along +x, half of the room; the eyes see all around.
  EXPECT_TRUE(found.seen.has_seen(floor.plan.cell_at({1.0, 3.0})));
  EXPECT_FALSE(found.drawn.has_seen(floor.plan.cell_at({1.0, 3.0})));
  EXPECT_TRUE(found.drawn.has_seen(floor.plan.cell_at({5.0, 3.0})));
}

TEST(Explore, TheEyesSeeFourFifthsOfTheRange) {
  std::vector<Edge> edges;
  add_wall(edges, {0.0, 0.0}, {20.0, 0.0});
  add_wall(edges, {20.0, 0.0}, {20.0, 20.0});
  add_wall(edges, {20.0, 20.0}, {0.0, 20.0});
  add_wall(edges, {0.0, 20.0}, {0.0, 0.0});
  const Floor floor(edges);
  Errand errand = errand_from(floor, {10.05, 10.05});
  errand.longest_way = 0.0;
  errand.sensor.range = 6.0;
  errand.sensor.cleared_share = 0.5;
  errand.sensor.field_of_view = kWholeTurn;
  const Exploration found = explore(floor.plan, floor.caster, errand);
  for (const int cell : floor.plan.free_cells()) {
    const Point2 at = floor.plan.centre(cell);
    const double away = std::hypot(at.x - 10.05, at.y - 10.05);
    // Cells of the raster are 0.4 m wide.
    if (away < 4.8 - 0.6) {
      EXPECT_TRUE(found.seen.has_seen(cell)) << away;
    }
    if (away > 4.8 + 0.6) {
      EXPECT_FALSE(found.seen.has_seen(cell)) << away;
    }
    // No wall is in the range: the finder draws half of it.
    if (away < 3.0 - 0.6) {
      EXPECT_TRUE(found.drawn.has_seen(cell)) << away;
    }
    if (away > 3.0 + 0.6) {
      EXPECT_FALSE(found.drawn.has_seen(cell)) << away;
    }
  }
}

TEST(Explore, ScansWhereItTurnsSharply) {
  const Floor floor(two_rooms());
  Errand errand = errand_from(floor, {0.55, 5.45});
  errand.scan_every = 1e6;  // nowhere else
  errand.sensor.range = 2.0;
  const Exploration found = explore(floor.plan, floor.caster, errand);
  ASSERT_GT(found.poses.size(), 3U);
  for (std::size_t i = 1; i < found.poses.size(); ++i)
    EXPECT_GT(std::abs(normalize_angle(found.poses[i].theta - found.poses[i - 1].theta)), 1.0) << i;
}

}  // namespace
}  // namespace gridmerge::internal
