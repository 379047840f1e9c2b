// SPDX-License-Identifier: Apache-2.0
// What options may be: the limits themselves are fine, what is beyond is refused by name.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <string>
#include <vector>

#include "gridmerge/simulate/simulate.hpp"
#include "io/support.hpp"

namespace gridmerge {
namespace {

using test::contains;

template <typename Call>
std::string complaint(const Call& call) {
  try {
    call();
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return {};
}

/// A number among the options, and what it may be.
struct Limits {
  double SimulateOptions::*value;
  double least, most;
  const char* what;
};

constexpr Limits kOfMapping[] = {
    {&SimulateOptions::robot_radius, 0.05, 5.0, "radius"},
    {&SimulateOptions::scan_every, 0.02, 10.0, "metres apart"},
    {&SimulateOptions::drift, 0.0, 10.0, "drift"},
    {&SimulateOptions::clutter, 0.0, 10.0, "clutter"},
    {&SimulateOptions::resolution, 0.01, 1.0, "resolution"},
};

/// No robot of this size can stand in this building: whatever may be ends with that, and soon.
SimulateOptions crammed() {
  SimulateOptions options;
  options.width = options.height = 8.0;
  options.robot_radius = 5.0;
  return options;
}

constexpr const char* kNoRoom = "no robot of this radius can stand in the building";

void expect_fine(const SimulateOptions& options) {
  EXPECT_EQ(complaint([&] { validate(options); }), "");
  EXPECT_EQ(complaint([&] { simulate(options); }), kNoRoom);
}

void expect_refused(const SimulateOptions& options, const char* what) {
  EXPECT_TRUE(contains(complaint([&] { validate(options); }), what));
  EXPECT_TRUE(contains(complaint([&] { simulate(options); }), what));
}

TEST(SimulateLimits, OfNumbersAreFineThemselves) {
  for (const Limits& limits : kOfMapping) {
    SCOPED_TRACE(limits.what);
    SimulateOptions options = crammed();
    const double range = limits.most - limits.least;
    for (const double beyond : {limits.least - 1e-6 * range, limits.most + 1e-6 * range,
                                std::numeric_limits<double>::quiet_NaN()}) {
      options.*limits.value = beyond;
      expect_refused(options, limits.what);
    }
    options.*limits.value = limits.most;
    expect_fine(options);
    options.*limits.value = limits.least;
    if (limits.value != &SimulateOptions::robot_radius) {
      expect_fine(options);
      continue;
    }
    options.longest_way = 0.0;  // so small a robot finds room, and stays where it is
    EXPECT_EQ(complaint([&] { simulate(options); }), "");
  }
  SimulateOptions options = crammed();
  options.longest_way = 1e5;
  expect_fine(options);
  options.longest_way = 100001.0;
  expect_refused(options, "longest way");
  options.longest_way = -0.001;
  expect_refused(options, "longest way");
}

TEST(SimulateLimits, OfSidesAreFineThemselves) {
  SimulateOptions options = crammed();
  options.height = 7.9;
  expect_refused(options, "sides must be between 8 and 500 metres");
  options.height = 8.0;
  options.width = 500.1;
  expect_refused(options, "sides must be between 8 and 500 metres");
}

TEST(SimulateLimits, OfCountsAreFineThemselves) {
  SimulateOptions options = crammed();
  for (const int count : {1, 1000}) {
    options.robots = options.steps = count;
    expect_fine(options);
  }
  for (const int count : {0, 1001}) {
    options = crammed();
    options.robots = count;
    expect_refused(options, "between 1 and 1000 robots");
    options = crammed();
    options.steps = count;
    expect_refused(options, "between 1 and 1000 steps");
  }
  options = crammed();
  options.threads = -1;
  expect_refused(options, "threads");
}

TEST(SimulateLimits, OfWhatMayBeLeftOut) {
  SimulateOptions options = crammed();
  for (const double overlap : {0.0, 1.0}) {
    options.overlap = overlap;
    expect_fine(options);
  }
  for (const double overlap : {-0.001, 1.001}) {
    options.overlap = overlap;
    expect_refused(options, "overlap must lie");
  }
  options.overlap = 0.5;
  options.robots = 1;
  expect_refused(options, "two robots");
  options = crammed();
  for (const double tidy : {0.0, 1.0}) {
    options.tidy = tidy;
    expect_fine(options);
  }
  for (const double tidy : {-0.001, 1.001}) {
    options.tidy = tidy;
    expect_refused(options, "thicker");
  }
  options = crammed();
  options.starts = {{1.0, 1.0}, {2.0, 2.0}};
  options.headings = {0.0, 9.0};
  expect_fine(options);
  options.starts.pop_back();
  expect_refused(options, "a start for every robot");
  options.starts.clear();
  options.headings.push_back(0.0);
  expect_refused(options, "a heading for every robot");
  options.headings = {0.0, HUGE_VAL};
  expect_refused(options, "headings must be finite");
}

TEST(RangeFinderLimits, AreFineThemselves) {
  const auto told = [](double RangeFinder::*value, double number) {
    RangeFinder sensor;
    sensor.*value = number;
    return complaint([&] { validate(sensor); });
  };
  struct Of {
    double RangeFinder::*value;
    double least, most;
    const char* what;
  };
  const double degree = std::numbers::pi / 180.0;
  for (const Of& limits :
       {Of{&RangeFinder::field_of_view, degree, 2.0 * std::numbers::pi, "field of view"},
        Of{&RangeFinder::angular_step, 1e-4, RangeFinder{}.field_of_view, "angular step"},
        Of{&RangeFinder::range, 0.2, 200.0, "range"}, Of{&RangeFinder::noise, 0.0, 10.0, "noise"},
        Of{&RangeFinder::stray_share, 0.0, 1.0, "shares"}, Of{&RangeFinder::missed_share, 0.0, 1.0, "shares"},
        Of{&RangeFinder::cleared_share, 0.0, 1.0, "shares"}}) {
    SCOPED_TRACE(limits.what);
    EXPECT_EQ(told(limits.value, limits.least), "");
    EXPECT_EQ(told(limits.value, limits.most), "");
    EXPECT_TRUE(contains(told(limits.value, limits.most + 1e-6), limits.what));
    if (limits.value != &RangeFinder::field_of_view) {
      EXPECT_TRUE(contains(told(limits.value, limits.least - 1e-6), limits.what));
    }
  }
  EXPECT_TRUE(contains(told(&RangeFinder::field_of_view, 0.0), "field of view"));
}

TEST(Elsewhere, IsAnotherBuildingForEachNumber) {
  SimulateOptions options;
  options.seed = 7;
  options.robots = 3;
  options.overlap = 0.5;
  options.starts = {{1.0, 1.0}};
  options.headings = {1.0};
  const SimulateOptions first = elsewhere(options, 0);
  EXPECT_EQ(first.robots, 1);
  EXPECT_FALSE(first.overlap);
  EXPECT_TRUE(first.starts.empty());
  EXPECT_TRUE(first.headings.empty());
  EXPECT_EQ(first.seed, 7000022u);  // what this seed has meant so far
  EXPECT_EQ(elsewhere(options, 5).seed, 7000027u);
}

TEST(BuildingLimits, AreFineThemselves) {
  const Edge wall{{1.0, 1.0}, {2.0, 1.0}};
  const auto told = [](const Building& building) { return complaint([&] { validate(building); }); };
  EXPECT_EQ(told({BuildingKind::bare, 500.0, 1e-3, {wall}}), "");
  EXPECT_TRUE(contains(told({BuildingKind::bare, 500.1, 20.0, {wall}}), "sides must be positive"));
  // Edges may end as far beyond a side as the longest side is long.
  for (const Point2 end : {Point2{-500.0, -500.0}, Point2{520.0, 510.0}})
    EXPECT_EQ(told({BuildingKind::bare, 20.0, 10.0, {{wall.a, end}, {end, wall.a}}}), "");
  for (const Point2 end : {Point2{-500.1, 0.0}, Point2{0.0, -500.1}, Point2{520.1, 0.0}, Point2{0.0, 510.1}})
    EXPECT_TRUE(contains(told({BuildingKind::bare, 20.0, 10.0, {{wall.a, end}}}), "beyond its sides"));
  for (const double echo : {0.0, 1.0})
    EXPECT_EQ(told({BuildingKind::bare, 20.0, 10.0, {{wall.a, wall.b, echo}}}), "");
  const Building small{BuildingKind::bare, 1.0, 1.0, {wall}};
  for (const double resolution : {0.01, 1.0}) EXPECT_NO_THROW(draw_building(small, resolution));
  for (const double resolution : {0.0099, 1.01})
    EXPECT_TRUE(contains(complaint([&] { draw_building(small, resolution); }), "resolution"));
  EXPECT_NO_THROW(make_building(BuildingKind::bare, 8.0, 8.0, 1));
  EXPECT_NO_THROW(make_building(BuildingKind::bare, 500.0, 8.0, 1));
}

TEST(DrawBuilding, HasAMarginOfAMetre) {
  Building square{BuildingKind::bare, 6.0, 4.0, {}};
  square.edges = {
      {{0.0, 0.0}, {6.0, 0.0}}, {{6.0, 0.0}, {6.0, 4.0}}, {{6.0, 4.0}, {0.0, 4.0}}, {{0.0, 4.0}, {0.0, 0.0}}};
  const OccupancyGrid map = draw_building(square, 0.5);
  EXPECT_EQ(map.width, 16);
  EXPECT_EQ(map.height, 12);
  EXPECT_EQ(map.origin, (SE2{-1.0, -1.0, 0.0}));
  for (int row = 0; row < map.height; ++row) {
    for (int column = 0; column < map.width; ++column) {
      const bool is_outside = column < 2 || column > 14 || row < 2 || row > 10;
      const bool is_wall = !is_outside && (column == 2 || column == 14 || row == 2 || row == 10);
      EXPECT_EQ(map.at(column, row), is_outside ? Cell::unknown
                                     : is_wall  ? Cell::occupied
                                                : Cell::free)
          << column << ' ' << row;
    }
  }
}

}  // namespace
}  // namespace gridmerge
