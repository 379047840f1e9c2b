// SPDX-License-Identifier: Apache-2.0
#include "simulate/survey.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "simulate/visit.hpp"

namespace gridmerge::internal {
namespace {

TEST(DrawnPlaces, AreMeansOfWhatWasAdded) {
  DrawnPlaces places(10.0, 5.0, 2.0);
  // Twice is too little, three times is drawn.
  places.add({1.05, 1.05}, {-1.0, 0.0});
  places.add({1.15, 1.20}, {-2.0, 3.0});
  EXPECT_EQ(places.count(), 0);
  EXPECT_TRUE(places.building_and_map().empty());
  places.add({1.20, 1.15}, {-3.0, 6.0});
  EXPECT_EQ(places.count(), 1);
  // Another square, in the margin; and what lies beyond it is left out, on every side.
  for (int i = 0; i < 3; ++i) {
    places.add({-1.9, 6.9}, {5.0, 5.0});
    for (const Point2 outside : {Point2{-2.3, 1.0}, {1.0, -2.3}, {12.6, 1.0}, {1.0, 7.6}})
      places.add(outside, {0.0, 0.0});
  }
  EXPECT_EQ(places.count(), 2);
  const std::vector<PointPair> pairs = places.building_and_map();
  ASSERT_EQ(pairs.size(), 2U);
  EXPECT_NEAR(pairs[0].in_a.x, (1.05 + 1.15 + 1.20) / 3.0, 1e-12);
  EXPECT_NEAR(pairs[0].in_a.y, (1.05 + 1.20 + 1.15) / 3.0, 1e-12);
  EXPECT_NEAR(pairs[0].in_b.x, -2.0, 1e-12);
  EXPECT_NEAR(pairs[0].in_b.y, 3.0, 1e-12);
  EXPECT_NEAR(pairs[1].in_a.x, -1.9, 1e-12);
  EXPECT_NEAR(pairs[1].in_b.y, 5.0, 1e-12);
}

TEST(DrawnPlaces, InCommonAreThoseThatBothDrew) {
  DrawnPlaces a(10.0, 10.0, 0.0), b(10.0, 10.0, 0.0);
  for (int i = 0; i < 3; ++i) {
    for (const double x : {1.1, 3.1}) a.add({x, 1.1}, {x + i, 10.0});
    for (const double x : {3.1, 5.1}) b.add({x, 1.1}, {x, 20.0 + i});
  }
  b.add({1.1, 1.1}, {0.0, 0.0});
  const std::vector<PointPair> common = common_places(a, b);
  ASSERT_EQ(common.size(), 1U);
  EXPECT_NEAR(common[0].in_a.x, 4.1, 1e-12);
  EXPECT_NEAR(common[0].in_a.y, 10.0, 1e-12);
  EXPECT_NEAR(common[0].in_b.x, 3.1, 1e-12);
  EXPECT_NEAR(common[0].in_b.y, 21.0, 1e-12);
}

/// A hall of 10 m x 6 m.
Building hall(double echo = 1.0) {
  Building building{BuildingKind::bare, 10.0, 6.0, {}};
  building.edges = {{{0.0, 0.0}, {10.0, 0.0}, 1.0},
                    {{10.0, 0.0}, {10.0, 6.0}, 1.0},
                    {{10.0, 6.0}, {0.0, 6.0}, 1.0},
                    {{0.0, 6.0}, {0.0, 0.0}, 1.0}};
  // A pane across it.
  building.edges.push_back({{7.0, 0.5}, {7.0, 5.5}, echo});
  return building;
}

/// An exact range finder on a robot that does not drift.
SimulateOptions exact() {
  SimulateOptions options;
  options.drift = 0.0;
  options.clutter = 0.0;
  options.sensor = {2.0 * std::numbers::pi, 0.01, 20.0, 0.5, 0.0, 0.0, 0.0};
  return options;
}

Survey look_from(const SE2& pose, const SimulateOptions& options, const Building& building, int scans = 12) {
  const FloorPlan plan(building.edges, options.robot_radius);
  const Visit visit{RayCaster(building.edges), plan};
  return survey(options, building, visit, std::vector<SE2>(static_cast<std::size_t>(scans), pose), Random(3));
}

/// The distances of occupied cells from the robot, along the building's directions.
std::vector<Point2> occupied_about(const Survey& made, const SE2& robot) {
  std::vector<Point2> cells;
  const OccupancyGrid& grid = made.map.grid;
  for (int row = 0; row < grid.height; ++row) {
    for (int column = 0; column < grid.width; ++column) {
      if (grid.at(column, row) != Cell::occupied) continue;
      const Point2 p = made.map.T_building_map * grid.cell_centre(column, row);
      cells.push_back({p.x - robot.x, p.y - robot.y});
    }
  }
  return cells;
}

TEST(Survey, AnExactRangeFinderDrawsTheWallsWhereTheyAre) {
  const SE2 robot{4.0, 2.5, 0.7};
  const Survey made = look_from(robot, exact(), hall());
  const std::vector<Point2> cells = occupied_about(made, robot);
  ASSERT_GT(cells.size(), 200U);
  int left = 0, pane = 0, beyond = 0;
  for (const Point2& cell : cells) {
    const double x = cell.x + robot.x, y = cell.y + robot.y;
    const double off =
        std::min({std::abs(x), std::abs(y), std::abs(6.0 - y), std::abs(7.0 - x), std::abs(10.0 - x)});
    EXPECT_LT(off, 0.11) << x << ' ' << y;
    left += x < 0.15 ? 1 : 0;
    pane += std::abs(7.0 - x) < 0.15 ? 1 : 0;
    beyond += x > 7.3 ? 1 : 0;
  }
  // Whole walls of 6 m and 5 m, in cells of 0.05 m; past the pane, corners of the hall.
  EXPECT_GT(left, 100);
  EXPECT_GT(pane, 80);
  EXPECT_LT(beyond, 60);
  EXPECT_LT(made.map.bend, 0.02);
  EXPECT_EQ(made.map.path.size(), 12U);
  // The map's frame has its origin at the robot.
  EXPECT_NEAR(made.map.T_building_map.x, robot.x, 0.02);
  EXPECT_NEAR(made.map.T_building_map.y, robot.y, 0.02);
}

TEST(Survey, BeamsGoThroughGlassThatDoesNotReflect) {
  const SE2 robot{4.0, 3.0, 0.0};
  const auto count = [&](double echo, auto is_wanted) {
    const Survey made = look_from(robot, exact(), hall(echo), 1);
    const std::vector<Point2> cells = occupied_about(made, robot);
    return std::count_if(cells.begin(), cells.end(), is_wanted);
  };
  const auto on_pane = [](const Point2& p) { return std::abs(p.x - 3.0) < 0.15 && std::abs(p.y) < 2.0; };
  const auto on_far_wall = [](const Point2& p) { return std::abs(p.x - 6.0) < 0.15 && std::abs(p.y) < 2.0; };
  EXPECT_EQ(count(0.0, on_pane), 0);
  EXPECT_GT(count(0.0, on_far_wall), 20);
  EXPECT_GT(count(1.0, on_pane), 40);
  EXPECT_EQ(count(1.0, on_far_wall), 0);
  EXPECT_GT(count(0.5, on_pane), 10);
  EXPECT_GT(count(0.5, on_far_wall), 10);
}

TEST(Survey, BeamsThatComeBackWithNothingClearAShareOfTheRange) {
  const SE2 robot{4.0, 3.0, 0.0};
  SimulateOptions options = exact();
  options.sensor.missed_share = 1.0;
  options.sensor.range = 4.0;
  // Nothing is nearer than 2 m: beams count as free for half of what they would have met, 2 m at most.
  const Survey made = look_from(robot, options, hall());
  EXPECT_TRUE(occupied_about(made, robot).empty());
  const double area = static_cast<double>(count_cells(made.map.grid).free) * 0.05 * 0.05;
  // To the pane at 3 m and the walls at 3 m: halves of them, a square of 3 m but for the open end at -x.
  EXPECT_GT(area, 0.8 * 9.0);
  EXPECT_LT(area, 1.1 * std::numbers::pi * 4.0);
}

TEST(Survey, NoiseAndStrayBeamsAreAsFarOffAsTheySay) {
  const SE2 robot{4.0, 3.0, 0.0};
  SimulateOptions options = exact();
  options.sensor.noise = 0.1;
  double squares = 0.0;
  int count = 0;
  for (const Point2& p : occupied_about(look_from(robot, options, hall(), 1), robot)) {
    if (std::abs(p.x + 4.0) > 0.6 || std::abs(p.y) > 2.0) continue;
    squares += (p.x + 4.0) * (p.x + 4.0);
    ++count;
  }
  ASSERT_GT(count, 50);
  // Along the wall's normal a little less than along beams; cells that later beams cross count as free.
  EXPECT_NEAR(std::sqrt(squares / count), 0.09, 0.035);

  options = exact();
  options.sensor.stray_share = 1.0;
  int near = 0, all = 0;
  for (const Point2& p : occupied_about(look_from(robot, options, hall(), 1), robot)) {
    ++all;
    near += std::hypot(p.x, p.y) < 2.9 ? 1 : 0;
  }
  EXPECT_GT(near, all / 2);  // no wall is nearer than 3 m
}

TEST(Survey, LooksAheadWithinItsField) {
  const SE2 robot{4.0, 3.0, 0.5 * std::numbers::pi};
  SimulateOptions options = exact();
  options.sensor.field_of_view = 0.5 * std::numbers::pi;
  const std::vector<Point2> cells = occupied_about(look_from(robot, options, hall()), robot);
  ASSERT_GT(cells.size(), 50U);
  double left = 0.0, right = 0.0;
  for (const Point2& p : cells) {
    EXPECT_GT(p.y, 2.8);
    left = std::min(left, p.x);
    right = std::max(right, p.x);
  }
  EXPECT_NEAR(left, -3.0, 0.15);
  EXPECT_NEAR(right, 3.0, 0.15);
}

TEST(Survey, KeepsTheMapAfterEqualPartsOfTheWay) {
  SimulateOptions options = exact();
  options.steps = 4;
  const Building building = hall();
  const FloorPlan plan(building.edges, options.robot_radius);
  const Visit visit{RayCaster(building.edges), plan};
  options.sensor.range = 2.0;
  std::vector<SE2> path;
  for (int i = 0; i < 16; ++i) path.push_back({1.0 + 0.3 * i, 3.0, 0.0});
  const Survey all = survey(options, building, visit, path, Random(3));
  ASSERT_EQ(all.map.earlier.size(), 3U);
  // The first quarter is the map of a robot that stops then.
  options.steps = 1;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::vector<SE2> part(path.begin(), path.begin() + 4 * (static_cast<std::ptrdiff_t>(i) + 1));
    EXPECT_EQ(survey(options, building, visit, part, Random(3)).map.grid.cells, all.map.earlier[i].cells)
        << i;
  }
}

}  // namespace
}  // namespace gridmerge::internal
