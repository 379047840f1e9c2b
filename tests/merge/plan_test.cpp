// SPDX-License-Identifier: Apache-2.0
#include "gridmerge/merge/plan.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include "grid/quarter_turned.hpp"
#include "match/scaled_pose.hpp"
#include "merge/maps_left_out.hpp"
#include "merge/team.hpp"
#include "support/building.hpp"

namespace gridmerge {

using namespace internal;
using namespace test;
namespace {

/// Two robots at the two ends of one building, which have nothing in common, and its plan.
struct Ends {
  Ends() {
    const OccupancyGrid building = draw_building(1);
    const std::vector<Window> windows{{0, 0, 9, 13}, {9, 0, 18, 13}};
    for (std::size_t i = 0; i < windows.size(); ++i) {
      T_map_building.push_back({2.0 - 5.0 * static_cast<double>(i), 4.0, 0.9 * static_cast<double>(i) - 0.3});
      maps.push_back(map_part(building, windows[i], T_map_building.back()));
    }
    plan = scaled(building, 0.8);
  }

  /// Both hang on a plan whose frame is the building's, but for its scale and T_plan_building.
  void expect_on_plan(const MergeResult& result, const SE2& T_plan_building = {}) const {
    ASSERT_EQ(result.components.size(), 1u);
    const Component& component = result.components[0];
    EXPECT_TRUE(component.in_world_frame);
    ASSERT_EQ(component.members.size(), 2u);
    for (const Member& member : component.members) {
      const SE2 off = T_plan_building * inverse(T_map_building[member.map]) * inverse(member.T_component_map);
      const Point2 middle = T_plan_building * Point2{9.0, 6.5};
      const Point2 moved = off * middle;
      EXPECT_NEAR(moved.x, middle.x, 0.3) << member.map;
      EXPECT_NEAR(moved.y, middle.y, 0.3) << member.map;
      EXPECT_NEAR(off.theta, 0.0, 0.03);
      EXPECT_GE(*member.probability, 0.95);
      EXPECT_GT(member.sd->position, 0.0);
    }
    EXPECT_TRUE(result.left_out.empty());
  }

  std::vector<OccupancyGrid> maps;
  std::vector<SE2> T_map_building;
  OccupancyGrid plan;
};

PlanOptions at_scales(double least, double most) {
  PlanOptions options;
  options.scales = {least, most};
  return options;
}

/// Maps that a merge left apart, without the time of one.
MergeResult apart(std::size_t maps) {
  MergeResult merged;
  for (std::size_t i = 0; i < maps; ++i) merged.left_out.push_back({i, Reason::too_little_overlap});
  merged.expected_false_joins = 0.0;
  return merged;
}

TEST(PlaceOnPlan, JoinsMapsThatShareNothing) {
  const Ends ends;
  const MergeResult merged = merge(ends.maps);
  EXPECT_EQ(maps_left_out(merged), (std::vector<std::size_t>{0, 1}));
  PlanOptions options = at_scales(0.9, 1.6);
  options.name = "floor";
  const MergeResult result = place_on_plan(ends.maps, ends.plan, merged, {}, options);
  ends.expect_on_plan(result);
  ASSERT_TRUE(result.plan);
  EXPECT_EQ(result.plan->name, "floor");
  EXPECT_NEAR(result.plan->scale, 1.25, 0.02);
  ASSERT_EQ(result.plan->parts.size(), 2u);
  double doubt = 0.0;
  for (std::size_t i = 0; i < 2; ++i) {
    const PlanPart& part = result.plan->parts[i];
    EXPECT_EQ(part.maps, std::vector{i});
    EXPECT_TRUE(part.on_plan());
    EXPECT_EQ(part.T_plan_first, result.components[0].members[i].T_component_map);
    EXPECT_LE(part.probability, result.plan->probability());
    doubt += 1.0 - part.probability;
  }
  EXPECT_NEAR(*result.expected_false_joins, doubt, 1e-12);
  // The maps alone: where neither has been nothing is known.
  const OccupancyGrid& fused = result.components[0].fused.grid;
  EXPECT_LE(count_cells(fused).known(),
            count_cells(ends.maps[0]).known() + count_cells(ends.maps[1]).known());
  EXPECT_NEAR(fused.width * fused.resolution, 18.0, 1.0);
}

TEST(PlaceOnPlan, TakesALineDrawing) {
  const Ends ends;
  OccupancyGrid lines = ends.plan;
  for (Cell& cell : lines.cells) cell = cell == Cell::occupied ? cell : Cell::unknown;
  ends.expect_on_plan(place_on_plan(ends.maps, lines, apart(2), {}, at_scales(1.0, 1.5)));
}

TEST(PlaceOnPlan, HangsAComponentWithItsMembers) {
  const Team team;
  const MergeResult merged = merge(team.maps);
  const SE2 T_plan_building{-4.0, 1.0, 2.0};
  OccupancyGrid plan = draw_building(1);
  plan.origin = T_plan_building * plan.origin;
  const MergeResult result = place_on_plan(team.maps, scaled(plan, 1.25), merged, {}, at_scales(0.7, 1.1));
  team.expect_merged(result);
  ASSERT_TRUE(result.plan);
  ASSERT_EQ(result.plan->parts.size(), 2u);
  EXPECT_EQ(result.plan->parts[0].maps, (std::vector<std::size_t>{0, 1, 2, 3}));
  EXPECT_TRUE(result.plan->parts[0].on_plan());
  EXPECT_FALSE(result.plan->parts[1].on_plan());  // of another building
  EXPECT_LT(result.plan->parts[1].probability, 0.95);
  EXPECT_NEAR(result.plan->scale, 0.8, 0.01);
  const Member& first = result.components[0].members[0];
  const Point2 corner = first.T_component_map * (team.T_map_building[0] * Point2{3.0, 2.0});
  EXPECT_NEAR(corner.x, (T_plan_building * Point2{3.0, 2.0}).x, 0.3);
  EXPECT_NEAR(corner.y, (T_plan_building * Point2{3.0, 2.0}).y, 0.3);
  // Within the part nothing has moved.
  const auto& before = merged.components[0].members;
  for (std::size_t i = 0; i < before.size(); ++i) {
    const SE2 is = inverse(first.T_component_map) * result.components[0].members[i].T_component_map;
    const SE2 was = inverse(before[0].T_component_map) * before[i].T_component_map;
    EXPECT_NEAR(is.x, was.x, 1e-9);
    EXPECT_NEAR(is.y, was.y, 1e-9);
    EXPECT_LE(*result.components[0].members[i].probability, *before[i].probability);
  }
}

TEST(PlaceOnPlan, LeavesAllAsItWasOnAStrangersPlan) {
  const Team team;
  const std::vector<OccupancyGrid> maps(team.maps.begin(), team.maps.end() - 1);
  const MergeResult merged = merge(maps);
  const MergeResult result = place_on_plan(maps, draw_building(3), merged, {}, at_scales(0.9, 1.2));
  expect_same(result, merged);
  EXPECT_EQ(result.expected_false_joins, merged.expected_false_joins);
  ASSERT_TRUE(result.plan);
  EXPECT_EQ(result.plan->probability(), 0.0);
  EXPECT_EQ(result.plan->scale, 1.0);
  for (const PlanPart& part : result.plan->parts) EXPECT_NE(part.reason, Reason::none);
}

TEST(PlaceOnPlan, KeepsABudgetOfFalseJoins) {
  const Ends ends;
  MergeOptions options;
  options.max_false_joins = 0.0;
  const MergeResult result = place_on_plan(ends.maps, ends.plan, apart(2), options, at_scales(1.2, 1.3));
  EXPECT_TRUE(result.components.empty());
  EXPECT_EQ(result.left_out.size(), 2u);
  for (const PlanPart& part : result.plan->parts) {
    EXPECT_FALSE(part.on_plan());
    EXPECT_TRUE(part.reason == Reason::over_budget || part.probability < options.match.accept_probability);
  }
  options.max_false_joins = 0.05;
  options.match.accept_probability = 1.0;
  EXPECT_TRUE(place_on_plan(ends.maps, ends.plan, apart(2), options, at_scales(1.2, 1.3)).components.empty());
}

/// Where there are many maps, their joins use their budget up.
TEST(PlaceOnPlan, HasABudgetBesideThatOfJoins) {
  const Ends ends;
  MergeResult merged = apart(2);
  merged.expected_false_joins = MergeOptions().max_false_joins;
  const MergeResult result = place_on_plan(ends.maps, ends.plan, merged, {}, at_scales(1.2, 1.3));
  ASSERT_EQ(result.components.size(), 1u);
  double doubt = 0.0;
  for (const PlanPart& part : result.plan->parts) {
    EXPECT_TRUE(part.on_plan());
    doubt += 1.0 - part.probability;
  }
  EXPECT_GT(doubt, 0.0);
  EXPECT_NEAR(*result.expected_false_joins, *merged.expected_false_joins + doubt, 1e-12);
}

/// A plan drawn `factor` times as large has that part of the scale, and nothing else changes.
TEST(PlaceOnPlan, ScalingThePlanScalesTheAnswer) {
  const Ends ends;
  const MergeResult as_is = place_on_plan(ends.maps, ends.plan, apart(2), {}, at_scales(1.1, 1.4));
  for (const double factor : {0.5, 2.0}) {  // powers of two: to the bit
    const MergeResult result = place_on_plan(ends.maps, scaled(ends.plan, factor), apart(2), {},
                                             at_scales(1.1 / factor, 1.4 / factor));
    expect_same(result, as_is);
    EXPECT_EQ(result.plan->scale * factor, as_is.plan->scale);
    EXPECT_EQ(result.plan->probability(), as_is.plan->probability());
  }
}

/// The same drawing, lying on its side.
OccupancyGrid on_its_side(const OccupancyGrid& plan) {
  OccupancyGrid turned = make_grid(plan.height, plan.width, plan.resolution);
  for (int row = 0; row < plan.height; ++row) {
    for (int column = 0; column < plan.width; ++column)
      turned.at(plan.height - 1 - row, column) = plan.at(column, row);
  }
  turned.origin = plan.origin * SE2{0.0, plan.height * plan.resolution, -std::numbers::pi / 2.0};
  return turned;
}

TEST(PlaceOnPlan, ATurnedPlanTurnsTheAnswer) {
  const Ends ends;
  std::mt19937 random(7);
  std::uniform_real_distribution<double> shift(-50.0, 50.0), turn(-3.1, 3.1);
  for (int i = 0; i < 6; ++i) {
    const SE2 T{shift(random), shift(random), turn(random)};
    OccupancyGrid plan = ends.plan;
    plan.origin = T * plan.origin;
    if (i % 2 == 1) plan = on_its_side(plan);
    const MergeResult result = place_on_plan(ends.maps, plan, apart(2), {}, at_scales(1.2, 1.3));
    ASSERT_TRUE(result.plan);
    EXPECT_NEAR(result.plan->scale, 1.25, 0.02);
    ends.expect_on_plan(result, {T.x * result.plan->scale, T.y * result.plan->scale, T.theta});
  }
}

TEST(PlaceOnPlan, DependsNeitherOnThreadsNorOnTheOrder) {
  const Ends ends;
  MergeOptions options;
  options.match.threads = 1;
  const PlanOptions scales = at_scales(1.2, 1.3);
  const MergeResult one = place_on_plan(ends.maps, ends.plan, apart(2), options, scales);
  options.match.threads = 4;
  const MergeResult four = place_on_plan(ends.maps, ends.plan, apart(2), options, scales);
  expect_same(one, four);
  EXPECT_EQ(one.plan->scale, four.plan->scale);
  const MergeResult swapped =
      place_on_plan({ends.maps[1], ends.maps[0]}, ends.plan, apart(2), options, scales);
  EXPECT_EQ(swapped.plan->scale, one.plan->scale);
  for (std::size_t i = 0; i < 2; ++i)
    EXPECT_EQ(swapped.components[0].members[i].T_component_map,
              one.components[0].members[1 - i].T_component_map);
}

TEST(PlaceOnPlan, HearsAllOfAPartTheSameWhicheverMapComesFirst) {
  const Team team;
  const OccupancyGrid plan = scaled(draw_building(1), 0.8);
  const auto placed = [&](const std::vector<OccupancyGrid>& maps) {
    return place_on_plan(maps, plan, merge(maps), {}, at_scales(1.2, 1.3));
  };
  const MergeResult one = placed(team.maps);
  const MergeResult other = placed({team.maps[4], team.maps[3], team.maps[2], team.maps[1], team.maps[0]});
  ASSERT_EQ(one.plan->parts.size(), 2u);
  ASSERT_EQ(other.plan->parts.size(), 2u);
  EXPECT_TRUE(one.plan->parts[0].on_plan());
  EXPECT_TRUE(other.plan->parts[1].on_plan());
  EXPECT_NEAR(other.plan->parts[1].probability, one.plan->parts[0].probability, 1e-9);
  EXPECT_NEAR(other.plan->scale, one.plan->scale, 1e-9);
}

TEST(PlaceOnPlan, APartWithoutAWallLeftSaysNothing) {
  // Where one map has walls the other has floor, of which it is surer.
  const auto floor_with_wall = [](int from, int to) {
    OccupancyGrid map = make_grid(60, 60, 0.05, {}, Cell::free);
    for (int i = from; i <= to; ++i) map.at(i, from) = Cell::occupied;
    for (const Cell cell : map.cells) map.probability.push_back(cell == Cell::occupied ? 0.66F : 0.05F);
    return map;
  };
  const std::vector<OccupancyGrid> maps{floor_with_wall(10, 14), floor_with_wall(33, 50)};
  MergeOptions options;
  options.match.accept_probability = 0.9;  // the maps say that the poses are doubtful
  options.max_false_joins = 1.0;
  const MergeResult merged = merge(maps, options, {KnownPose{{}, 0.01, 0.01}, KnownPose{{}, 0.01, 0.01}});
  ASSERT_EQ(merged.components.size(), 1u);
  ASSERT_EQ(count_cells(merged.components[0].fused.grid).occupied, 0u);
  const MergeResult result = place_on_plan(maps, Ends().plan, merged, {}, at_scales(1.2, 1.3));
  ASSERT_EQ(result.plan->parts.size(), 1u);
  EXPECT_FALSE(result.plan->parts[0].on_plan());
}

TEST(PlaceOnPlan, AMapThatHangsThereAloneStaysLeftOut) {
  const Ends ends;
  const std::vector<OccupancyGrid> maps{ends.maps[0], draw_building(2)};
  const MergeResult result = place_on_plan(maps, ends.plan, apart(2), {}, at_scales(1.2, 1.3));
  EXPECT_TRUE(result.components.empty());
  EXPECT_EQ(maps_left_out(result), (std::vector<std::size_t>{0, 1}));
  EXPECT_TRUE(result.plan->parts[0].on_plan());
  EXPECT_FALSE(result.plan->parts[1].on_plan());
  const Point2 corner = result.plan->parts[0].T_plan_first * (ends.T_map_building[0] * Point2{1.0, 1.0});
  EXPECT_NEAR(corner.x, 1.0, 0.3);
  EXPECT_NEAR(corner.y, 1.0, 0.3);
}

TEST(PlaceOnPlan, CountsACopyOnce) {
  const Ends ends;
  std::vector<OccupancyGrid> maps = ends.maps;
  maps.push_back(ends.maps[0]);
  const MergeResult merged = merge(maps);
  ASSERT_EQ(merged.components.size(), 1u);  // the map and its copy
  const MergeResult result = place_on_plan(maps, ends.plan, merged, {}, at_scales(1.2, 1.3));
  ASSERT_EQ(result.components.size(), 1u);
  ASSERT_EQ(result.components[0].members.size(), 3u);
  const MergeResult once = place_on_plan(ends.maps, ends.plan, apart(2), {}, at_scales(1.2, 1.3));
  EXPECT_EQ(result.components[0].fused.grid.cells, once.components[0].fused.grid.cells);
}

TEST(PlaceOnPlan, CountsACopyInAnotherFrameOnce) {
  const Ends ends;
  std::vector<OccupancyGrid> maps = ends.maps;
  maps.push_back(internal::quarter_turned(ends.maps[0], 1));
  maps.back().origin = SE2{4.0, -7.0, 0.4} * maps.back().origin;
  const MergeResult result = place_on_plan(maps, ends.plan, merge(maps), {}, at_scales(1.2, 1.3));
  ASSERT_EQ(result.components.size(), 1u);
  ASSERT_EQ(result.components[0].members.size(), 3u);
  const MergeResult once = place_on_plan(ends.maps, ends.plan, apart(2), {}, at_scales(1.2, 1.3));
  EXPECT_EQ(result.components[0].fused.agreeing, once.components[0].fused.agreeing);
  EXPECT_EQ(result.components[0].fused.grid.cells, once.components[0].fused.grid.cells);
}

TEST(PlaceOnPlan, MapsWithoutWallsStayOffThePlan) {
  const Ends ends;
  const std::vector<OccupancyGrid> maps{ends.maps[0], make_grid(40, 30, 0.1, {}, Cell::free),
                                        make_grid(5, 5, 0.1)};
  const MergeResult result = place_on_plan(maps, ends.plan, apart(3), {}, at_scales(1.2, 1.3));
  EXPECT_EQ(result.plan->parts[1].reason, Reason::nothing_to_compare);
  EXPECT_EQ(result.plan->parts[2].reason, Reason::nothing_to_compare);
  const MergeResult none = place_on_plan({}, ends.plan, {}, {}, {});
  EXPECT_TRUE(none.plan->parts.empty());
}

TEST(PlaceOnPlan, RefusesWhatMakesNoSense) {
  const Ends ends;
  const auto fails = [&](const OccupancyGrid& plan, const MergeResult& merged, const PlanOptions& options,
                         const std::string& why) {
    try {
      place_on_plan(ends.maps, plan, merged, {}, options);
      ADD_FAILURE() << "nothing is said of: " << why;
    } catch (const std::invalid_argument& error) {
      EXPECT_NE(std::string(error.what()).find(why), std::string::npos) << error.what();
    }
  };
  fails(make_grid(30, 20, 0.1, {}, Cell::free), apart(2), {}, "no walls");
  fails(make_grid(30, 20, 0.1, {}, Cell::occupied), apart(2), {}, "floor beside");
  OccupancyGrid corner = make_grid(100, 80, 0.05);  // encloses nothing
  for (int i = 10; i < 70; ++i) corner.at(i, 70) = corner.at(10, i) = Cell::occupied;
  fails(corner, apart(2), {}, "floor beside");
  fails(ends.maps[1], apart(2), {}, "map 1");
  fails(ends.plan, apart(2), at_scales(2.0, 1.0), "scales");
  fails(ends.plan, apart(2), at_scales(0.05, 2.0), "scales");
  fails(ends.plan, apart(2), at_scales(std::nan(""), 2.0), "scales");
  fails(ends.plan, apart(3), {}, "these maps");
  fails(ends.plan, apart(1), {}, "these maps");
  MergeResult fixed = apart(1);
  fixed.components.push_back({{{1, {}}}, {}, true});
  fails(ends.plan, fixed, {}, "fixed");
  OccupancyGrid broken = ends.plan;
  broken.cells.pop_back();
  fails(broken, apart(2), {}, "cell");
  broken = corner;  // a line drawing, of which lines alone are used: it has to be a grid all the same
  broken.probability = {50};
  fails(broken, apart(2), {}, "probabilities");
  broken = make_grid(30, 20, 0.1);
  broken.cells.clear();
  fails(broken, apart(2), {}, "cells do not number");
  for (const double budget : {std::nan(""), -0.1, HUGE_VAL}) {
    MergeOptions options;
    options.max_false_joins = budget;
    EXPECT_THROW(place_on_plan(ends.maps, ends.plan, apart(2), options), std::invalid_argument);
  }
  MergeOptions walk;
  walk.match.search = SearchMethod::random_walk;
  EXPECT_THROW(place_on_plan(ends.maps, ends.plan, apart(2), walk), std::invalid_argument);
}

}  // namespace
}  // namespace gridmerge
