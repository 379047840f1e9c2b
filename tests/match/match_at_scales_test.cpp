// SPDX-License-Identifier: Apache-2.0
#include "match/match_at_scales.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "gridmerge/simulate/simulate.hpp"
#include "match/scaled_pose.hpp"
#include "support/building.hpp"

namespace gridmerge {

using namespace internal;
namespace {

MatchOptions at_scales(double least, double most) {
  MatchOptions options;
  options.scales = ScaleRange{least, most};
  return options;
}

/// An apartment, as it is drawn and as a robot maps it, bent by drift.
struct PlanAndMap {
  OccupancyGrid plan;
  OccupancyGrid map;
  SE2 T_plan_map;
};

const PlanAndMap& apartment() {
  static const PlanAndMap made = [] {
    SimulateOptions options;
    options.kind = BuildingKind::apartment;
    options.width = 16.0;
    options.height = 11.0;
    options.robots = 1;
    options.drift = 1.0;
    options.clutter = 0.5;
    options.seed = 3;
    const Simulation simulation = simulate(options);
    return PlanAndMap{draw_building(simulation.building, 0.05), simulation.maps[0].grid,
                      simulation.maps[0].T_building_map};
  }();
  return made;
}

/// How far apart two scaled poses put the corners of a map.
double apart(const OccupancyGrid& map, const ScaledPose& a, const ScaledPose& b) {
  double most = 0.0;
  for (const Point2 corner :
       {Point2{0.0, 0.0}, Point2{map.width * map.resolution, 0.0}, Point2{0.0, map.height * map.resolution},
        Point2{map.width * map.resolution, map.height * map.resolution}}) {
    const Point2 p = a * (map.origin * corner), q = b * (map.origin * corner);
    most = std::max(most, std::hypot(p.x - q.x, p.y - q.y));
  }
  return most;
}

TEST(Levels, CoverTheRangeEvenly) {
  for (const double unit : {1.0, 0.4, 7.3}) {
    const std::vector<double> levels = levels_of({0.5, 2.0}, unit);
    EXPECT_NEAR(std::log(levels.front()), std::log(0.5), 0.0151);
    EXPECT_NEAR(std::log(levels.back()), std::log(2.0), 0.0151);
    for (std::size_t i = 2; i + 1 < levels.size(); ++i)
      EXPECT_NEAR(std::log(levels[i] / levels[i - 1]), 0.03, 1e-12);
    for (const double level : levels) {
      EXPECT_GE(level, 0.5);
      EXPECT_LE(level, 2.0);
    }
    EXPECT_EQ(levels_of({1.3, 1.3}, unit), std::vector{1.3});
  }
}

TEST(Levels, AreTheSameOfEveryRange) {
  const std::vector<double> all = levels_of({0.5, 2.0}, 1.2);
  for (const double level : levels_of({0.71, 1.37}, 1.2)) {
    const bool is_end = level == 0.71 || level == 1.37;
    EXPECT_TRUE(is_end || std::find(all.begin(), all.end(), level) != all.end()) << level;
  }
}

// A user who knows the scale better must not get a worse answer for it.
TEST(MatchAtScales, ANarrowerRangeIsNoLessSure) {
  const PlanAndMap& made = apartment();
  const OccupancyGrid plan = scaled(made.plan, 1.2);
  const MatchResult wide = match(plan, made.map, at_scales(0.8, 1.7));
  for (const auto& [least, most] : {std::pair(0.9, 1.6), {1.0, 1.4}, {1.07, 1.33}, {1.11, 1.3}}) {
    const MatchResult narrow = match(plan, made.map, at_scales(least, most));
    EXPECT_NEAR(narrow.scale / wide.scale, 1.0, 0.005) << least;
    EXPECT_GT(narrow.probability, wide.probability - 0.02) << least;
  }
}

TEST(MatchAtScales, FindsAMapOnAPlanOfAnotherScale) {
  const PlanAndMap& made = apartment();
  for (const double scale : {0.7, 1.0, 1.45}) {
    const OccupancyGrid plan = scaled(made.plan, scale);
    const MatchResult result = match(plan, made.map, at_scales(0.6 * scale, 1.3 * scale));
    EXPECT_EQ(result.verdict, Verdict::accepted) << scale << " " << result.probability;
    EXPECT_NEAR(result.scale / scale, 1.0, 0.03);
    const ScaledPose truth = ScaledPose{SE2{}, scale} * ScaledPose{made.T_plan_map, 1.0};
    EXPECT_LT(apart(made.map, truth, {result.T_fixed_moving, result.scale}), 0.8 * scale);
    EXPECT_GT(result.agreement, 0);
    EXPECT_GT(result.overlap, 0.5);
    ASSERT_FALSE(result.hypotheses.empty());
    EXPECT_EQ(result.hypotheses[0].scale, result.scale);
  }
}

TEST(MatchAtScales, FindsAPlanOnAMap) {
  const PlanAndMap& made = apartment();
  const MatchResult result = match(made.map, scaled(made.plan, 1.25), at_scales(0.6, 1.2));
  EXPECT_EQ(result.verdict, Verdict::accepted) << result.probability;
  EXPECT_NEAR(result.scale * 1.25, 1.0, 0.03);
}

TEST(MatchAtScales, FindsAMapOnALineDrawing) {
  const PlanAndMap& made = apartment();
  OccupancyGrid lines = scaled(made.plan, 1.2);
  for (Cell& cell : lines.cells) cell = cell == Cell::occupied ? cell : Cell::unknown;
  const MatchResult result = match(lines, made.map, at_scales(0.9, 1.6));
  EXPECT_EQ(result.verdict, Verdict::accepted) << result.probability;
  EXPECT_NEAR(result.scale / 1.2, 1.0, 0.03);
}

TEST(MatchAtScales, RefusesStrangers) {
  SimulateOptions other;
  other.kind = BuildingKind::apartment;
  other.width = 15.0;
  other.height = 12.0;
  for (std::uint64_t seed : {11, 12, 13}) {
    const OccupancyGrid plan =
        draw_building(make_building(other.kind, other.width, other.height, seed), 0.05);
    EXPECT_EQ(match(plan, apartment().map, at_scales(0.6, 1.6)).verdict, Verdict::refused) << seed;
  }
}

/// A map drawn `factor` times as large has that part of the scale, and nothing else changes.
TEST(MatchAtScales, ScalingTheMovingMapScalesTheAnswer) {
  const PlanAndMap& made = apartment();
  const MatchResult as_is = match(made.plan, made.map, at_scales(0.9, 1.1));
  for (const double factor : {2.0, 8.0}) {  // powers of two: to the bit
    const MatchResult result =
        match(made.plan, scaled(made.map, factor), at_scales(0.9 / factor, 1.1 / factor));
    EXPECT_EQ(result.scale * factor, as_is.scale);
    EXPECT_EQ(result.T_fixed_moving, as_is.T_fixed_moving);
    EXPECT_EQ(result.probability, as_is.probability);
  }
}

TEST(MatchAtScales, DoesNotDependOnThreads) {
  const PlanAndMap& made = apartment();
  MatchOptions options = at_scales(0.9, 1.1);
  options.threads = 1;
  const MatchResult one = match(made.plan, made.map, options);
  options.threads = 4;
  const MatchResult four = match(made.plan, made.map, options);
  EXPECT_EQ(one.T_fixed_moving, four.T_fixed_moving);
  EXPECT_EQ(one.scale, four.scale);
  EXPECT_EQ(one.probability, four.probability);
}

TEST(MatchAtScales, StaysWithinTheRange) {
  const PlanAndMap& made = apartment();
  const MatchResult result = match(scaled(made.plan, 1.3), made.map, at_scales(1.0, 1.26));
  for (const Hypothesis& one : result.hypotheses) {
    EXPECT_GE(one.scale, 1.0);
    EXPECT_LE(one.scale, 1.26);
  }
}

TEST(MatchAtScales, ProgressDoesNotFall) {
  const PlanAndMap& made = apartment();
  MatchOptions options = at_scales(0.95, 1.05);
  double last = 0.0;
  options.progress = [&](double share) {
    EXPECT_GE(share, last);
    EXPECT_LE(share, 1.0);
    last = share;
  };
  match(made.plan, made.map, options);
  EXPECT_EQ(last, 1.0);
}

TEST(MatchAtScales, AMapWithoutWallsIsAnError) {
  OccupancyGrid floor = make_grid(60, 40, 0.1);
  for (Cell& cell : floor.cells) cell = Cell::free;
  EXPECT_THROW(match(floor, apartment().map, at_scales(0.5, 2.0)), std::invalid_argument);
  EXPECT_THROW(match(apartment().map, floor, at_scales(0.5, 2.0)), std::invalid_argument);
}

TEST(MatchAtScales, SenselessRangesAreErrors) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinite = std::numeric_limits<double>::infinity();
  const std::vector<std::pair<double, double>> senseless{
      {0.0, 1.0}, {-1.0, 1.0}, {2.0, 0.5},   {nan, 1.0},  {1.0, nan},
      {nan, nan}, {1.0, 1e4},  {1e-4, 1e-3}, {0.5, 10.5}, {1.0, infinite}};
  for (const auto& [least, most] : senseless) {
    EXPECT_THROW(validate(ScaleRange{least, most}), std::invalid_argument) << least << " " << most;
    EXPECT_THROW(validate(at_scales(least, most)), std::invalid_argument);
  }
  EXPECT_NO_THROW(validate(ScaleRange{0.5, 10.0}));
  MatchOptions walk = at_scales(0.5, 2.0);
  walk.search = SearchMethod::random_walk;
  EXPECT_THROW(validate(walk), std::invalid_argument);
}

/// Whatever is drawn in tiny maps, there is an answer or a clear error.
RC_GTEST_PROP(MatchAtScales, TinyMapsHaveAnAnswerOrAnError, ()) {
  const auto any_map = [] {
    OccupancyGrid map = make_grid(*rc::gen::inRange(1, 14), *rc::gen::inRange(1, 14),
                                  *rc::gen::element(0.01, 0.05, 1.0, 10.0));
    for (Cell& cell : map.cells) cell = *rc::gen::element(Cell::unknown, Cell::free, Cell::occupied);
    return map;
  };
  MatchOptions options = at_scales(*rc::gen::element(0.05, 0.5, 1.0), 1.0);
  try {
    const MatchResult result = match(any_map(), any_map(), options);
    RC_ASSERT(result.scale > 0.0);
    RC_ASSERT(result.probability >= 0.0 && result.probability <= 1.0);
    RC_ASSERT(result.scale == 1.0 || result.scale >= options.scales->least);
  } catch (const std::invalid_argument& error) {
    RC_ASSERT(std::string(error.what()).find("no walls") != std::string::npos);
  }
}

}  // namespace
}  // namespace gridmerge
