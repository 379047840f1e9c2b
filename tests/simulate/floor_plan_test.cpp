// SPDX-License-Identifier: Apache-2.0
#include "simulate/floor_plan.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "gridmerge/simulate/simulate.hpp"
#include "simulate/explore.hpp"
#include "simulate/random.hpp"

namespace gridmerge {

using namespace internal;
namespace {

/// Two rooms of 6 m x 6 m with a door between them, and one that is closed.
std::vector<Edge> rooms() {
  Draughtsman pen;
  pen.wall({0.0, 0.0}, {15.0, 0.0});
  pen.wall({15.0, 0.0}, {15.0, 6.0});
  pen.wall({15.0, 6.0}, {0.0, 6.0});
  pen.wall({0.0, 6.0}, {0.0, 0.0});
  pen.wall({6.0, 0.0}, {6.0, 6.0}, {{2.5, 1.0, 0}});
  pen.wall({12.0, 0.0}, {12.0, 6.0});
  return pen.edges;
}

TEST(FloorPlan, KeepsWhatIsInsideAndConnectedAndWideEnough) {
  const FloorPlan plan(rooms(), 0.2);
  const auto is_free = [&](double x, double y) { return plan.is_free(plan.cell_at({x, y})); };
  EXPECT_TRUE(is_free(3.0, 3.0));
  EXPECT_TRUE(is_free(9.0, 3.0));
  EXPECT_TRUE(is_free(6.0, 3.0));
  EXPECT_FALSE(is_free(13.5, 3.0));  // closed
  EXPECT_FALSE(is_free(0.2, 3.0));   // too near to the wall
  EXPECT_EQ(plan.cell_at({30.0, 3.0}), -1);
  EXPECT_FALSE(FloorPlan(rooms(), 0.6).is_free(plan.cell_at({6.0, 3.0})));  // too wide for the door
  EXPECT_EQ(FloorPlan({}, 0.2).count_free(), 0);
  EXPECT_EQ(FloorPlan({{{0.0, 0.0}, {5.0, 0.0}, 1.0}}, 0.2).count_free(), 0);  // no inside
}

TEST(PathSearch, LeadsThroughTheDoorByFreeCells) {
  const FloorPlan plan(rooms(), 0.2);
  PathSearch search(plan);
  const int from = plan.cell_at({1.0, 5.0}), to = plan.cell_at({11.0, 5.0});
  double way = 0.0;
  ASSERT_EQ(search.search(from, 100.0,
                          [&](int cell, double distance) {
                            way = distance;
                            return cell == to;
                          }),
            to);
  const std::vector<Point2> path = search.path_to(to);
  EXPECT_EQ(plan.cell_at(path.front()), from);
  EXPECT_EQ(plan.cell_at(path.back()), to);
  bool through_door = false;
  for (std::size_t i = 0; i < path.size(); ++i) {
    EXPECT_TRUE(plan.is_free(plan.cell_at(path[i])));
    if (i > 0) {
      EXPECT_LT(std::hypot(path[i].x - path[i - 1].x, path[i].y - path[i - 1].y), 0.15);
    }
    through_door = through_door || (std::abs(path[i].x - 6.0) < 0.1 && std::abs(path[i].y - 3.0) < 0.5);
  }
  EXPECT_TRUE(through_door);
  // Around two corners of the door; steps to eight neighbours make ways up to 8 % longer.
  const double straight = 2.0 * std::hypot(5.0, 1.7);
  EXPECT_GT(way, 0.98 * straight);
  EXPECT_LT(way, 1.12 * straight);
  EXPECT_EQ(search.search(from, 5.0, [&](int cell, double) { return cell == to; }), -1);
}

TEST(Explore, SeesAllThatIsInReachAndNoMoreThanTheWayAllows) {
  for (const BuildingKind kind : building_kinds()) {
    const Building building = make_building(kind, 24.0, 18.0, 5);
    const FloorPlan plan(building.edges, 0.2);
    const RayCaster caster(building.edges);
    ASSERT_GT(plan.count_free(), 2000) << name_of(kind);
    Errand errand{plan.free_cells().front(), 1e6, 1e6, {}, 0.3};
    const Exploration all = explore(plan, caster, errand);
    for (const int cell : plan.free_cells()) ASSERT_TRUE(all.seen.has_seen(cell)) << name_of(kind);
    for (const SE2& pose : all.poses) ASSERT_TRUE(plan.is_free(plan.cell_at({pose.x, pose.y})));

    errand.longest_way = 10.0;
    const Exploration some = explore(plan, caster, errand);
    EXPECT_LT(some.seen.count(), all.seen.count()) << name_of(kind);
    double way = 0.0;
    for (std::size_t i = 1; i < some.poses.size(); ++i)
      way += std::hypot(some.poses[i].x - some.poses[i - 1].x, some.poses[i].y - some.poses[i - 1].y);
    EXPECT_LE(way, 10.2) << name_of(kind);

    errand.longest_way = 1e6;
    errand.reach = 3.0;
    for (const SE2& pose : explore(plan, caster, errand).poses) {
      const Point2 start = plan.centre(errand.start);
      EXPECT_LE(std::hypot(pose.x - start.x, pose.y - start.y), 3.6) << name_of(kind);
    }
  }
}

}  // namespace
}  // namespace gridmerge
