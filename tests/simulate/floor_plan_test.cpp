// SPDX-License-Identifier: Apache-2.0
#include "simulate/floor_plan.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

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

TEST(PathSearch, StepsAreAsLongAsTheyAreDrawn) {
  const FloorPlan plan(rooms(), 0.2);
  PathSearch search(plan);
  const int from = plan.cell_at({3.05, 3.05});
  const auto way_to = [&](int right, int up) {
    const int to = from + up * plan.width() + right;
    double way = -1.0;
    EXPECT_EQ(search.search(from, 100.0,
                            [&](int cell, double distance) {
                              way = distance;
                              return cell == to;
                            }),
              to);
    EXPECT_EQ(search.path_to(to).size(),
              static_cast<std::size_t>(std::max(std::abs(right), std::abs(up))) + 1);
    return way;
  };
  EXPECT_NEAR(way_to(0, 0), 0.0, 1e-12);
  for (const int sign : {1, -1}) {
    EXPECT_NEAR(way_to(10 * sign, 0), 1.0, 1e-12);
    EXPECT_NEAR(way_to(0, 10 * sign), 1.0, 1e-12);
    EXPECT_NEAR(way_to(10 * sign, 10), 1.4, 1e-12);
    EXPECT_NEAR(way_to(10 * sign, -10), 1.4, 1e-12);
    EXPECT_NEAR(way_to(10, 4 * sign), 0.6 + 4 * 0.14, 1e-12);
  }
  // As far as the reach, itself included, and no farther.
  const auto reaches = [&](double reach) {
    return search.search(from, reach, [&](int cell, double) { return cell == from + 5; }) >= 0;
  };
  EXPECT_TRUE(reaches(0.5001));
  EXPECT_FALSE(reaches(0.4999));
}

TEST(PathSearch, VisitsCellsByTheirDistance) {
  const FloorPlan plan(rooms(), 0.2);
  PathSearch search(plan);
  double last = 0.0;
  int visited = 0;
  search.search(plan.cell_at({3.05, 3.05}), 1e6, [&](int, double distance) {
    EXPECT_GE(distance, last);
    last = distance;
    ++visited;
    return false;
  });
  EXPECT_EQ(visited, plan.count_free());  // each once
}

TEST(FloorPlan, FindsTheFreeCellThatIsNearest) {
  const FloorPlan plan(rooms(), 0.2);
  const int cell = plan.cell_at({3.05, 3.05});
  EXPECT_EQ(plan.free_cell_near(plan.centre(cell), 0.0), cell);
  const Point2 in_the_wall{6.0, 5.0};
  const int near = plan.free_cell_near(in_the_wall, 1.0);
  ASSERT_GE(near, 0);
  const double away = std::hypot(plan.centre(near).x - 6.0, plan.centre(near).y - 5.0);
  for (const int other : plan.free_cells())
    EXPECT_GE(std::hypot(plan.centre(other).x - 6.0, plan.centre(other).y - 5.0), away);
  EXPECT_EQ(plan.free_cell_near(in_the_wall, 0.99 * away), -1);
  EXPECT_EQ(plan.free_cell_near(in_the_wall, 1.01 * away), near);
  EXPECT_EQ(plan.free_cell_near({std::nan(""), 3.0}, 1e9), -1);
}

TEST(FloorPlan, TellsItsCellsApart) {
  const FloorPlan plan(rooms(), 0.2);
  for (const int cell : {0, 1, plan.width() - 1, plan.width(), plan.cells() - 1})
    EXPECT_EQ(plan.cell_at(plan.centre(cell)), cell);
  const Point2 first = plan.centre(0), last = plan.centre(plan.cells() - 1);
  EXPECT_EQ(plan.cell_at({first.x - 0.06, first.y}), -1);
  EXPECT_EQ(plan.cell_at({first.x, first.y - 0.06}), -1);
  EXPECT_EQ(plan.cell_at({last.x + 0.06, last.y}), -1);
  EXPECT_EQ(plan.cell_at({last.x, last.y + 0.06}), -1);
  EXPECT_EQ(plan.cell_at({std::nan(""), 3.0}), -1);
}

}  // namespace
}  // namespace gridmerge
