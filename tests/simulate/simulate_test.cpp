// SPDX-License-Identifier: Apache-2.0
#include "gridmerge/simulate/simulate.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "gridmerge/evaluate/evaluate.hpp"
#include "similarity/agreement.hpp"
#include "simulate/walls_met.hpp"
#include "support/effort.hpp"

namespace gridmerge {
namespace {

SimulateOptions small(BuildingKind kind = BuildingKind::office) {
  SimulateOptions options;
  options.kind = kind;
  options.width = 24.0;
  options.height = 16.0;
  options.scan_every = 0.5;
  options.sensor.angular_step = 0.0175;
  options.seed = 3;
  return options;
}

TEST(Simulate, MapsLieOnTheirBuildingAndOnEachOtherUnderTheTruth) {
  for (const BuildingKind kind :
       building_kinds().first(test::repeats(building_kinds().size(), std::size_t{2}))) {
    SCOPED_TRACE(name_of(kind));
    SimulateOptions options = small(kind);
    options.drift = 0.0;
    options.clutter = 0.0;
    options.overlap = 0.4;
    const Simulation simulation = simulate(options);
    const OccupancyGrid building = draw_building(simulation.building, 0.05);
    ASSERT_EQ(simulation.maps.size(), 2U);
    for (const SimulatedMap& map : simulation.maps) {
      EXPECT_LT(map.bend, 0.05);
      EXPECT_GT(test::walls_met(building, map.grid, map.T_building_map, 0.15), 0.95);
      const SE2 wrong = map.T_building_map * SE2{0.0, 0.0, 0.1};
      EXPECT_LT(test::walls_met(building, map.grid, wrong, 0.15), 0.9);
    }
    ASSERT_EQ(simulation.pairs.size(), 1U);
    const SimulatedPair& pair = simulation.pairs.front();
    EXPECT_GT(test::walls_met(simulation.maps[0].grid, simulation.maps[1].grid, pair.T_fixed_moving, 0.15),
              0.8);
    EXPECT_LT(
        rms_displacement(simulation.maps[1].grid, pair.T_fixed_moving,
                         inverse(simulation.maps[0].T_building_map) * simulation.maps[1].T_building_map),
        0.1);
    EXPECT_NEAR(pair.tolerance, kMinTolerance, 0.05);
  }
}

TEST(Simulate, OverlapComesOutAboutAsAskedFor) {
  for (const double wanted : {0.15, 0.5, 0.8}) {
    double sum = 0.0;
    const int seeds = test::repeats(4, 1);
    for (int seed = 1; seed <= seeds; ++seed) {
      SimulateOptions options = small();
      options.seed = static_cast<std::uint64_t>(seed);
      options.overlap = wanted;
      const double overlap = simulate(options).overlap;
      EXPECT_NEAR(overlap, wanted, 0.1) << seed;
      sum += overlap;
    }
    EXPECT_NEAR(sum / seeds, wanted, seeds > 1 ? 0.05 : 0.1);
  }
}

TEST(Simulate, EachMapHasAFrameOfItsOwn) {
  SimulateOptions options = small(BuildingKind::hall);
  options.robots = 6;
  options.longest_way = 10.0;
  const Simulation simulation = simulate(options);
  std::vector<double> turns;
  for (const SimulatedMap& map : simulation.maps) {
    // Where it starts is the frame's zero, whichever way it looks.
    const SE2 start = inverse(map.T_building_map) * map.path.front();
    EXPECT_LT(std::hypot(start.x, start.y), 0.5);
    turns.push_back(map.T_building_map.theta);
  }
  for (std::size_t i = 0; i < turns.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) EXPECT_GT(std::abs(normalize_angle(turns[i] - turns[j])), 1e-3);
  }
  const auto [least, most] = std::minmax_element(turns.begin(), turns.end());
  EXPECT_GT(*most - *least, 1.5);
}

TEST(Simulate, RobotsStartFarFromEachOther) {
  SimulateOptions options = small();
  options.width = 60.0;
  options.longest_way = 0.5;
  const auto mean_distance = [&] {
    constexpr int kSeeds = 12;
    double sum = 0.0;
    for (int seed = 1; seed <= kSeeds; ++seed) {
      options.seed = static_cast<std::uint64_t>(seed);
      const Simulation simulation = simulate(options);
      const auto start = [&](std::size_t i) { return simulation.maps.at(i).path.front(); };
      sum += std::hypot(start(0).x - start(1).x, start(0).y - start(1).y);
    }
    return sum / kSeeds;
  };
  options.robots = 2;
  // Of two random places along a line the distance is a third of its length; the farther of six is farther.
  EXPECT_GT(mean_distance(), 0.5 * options.width);
}

TEST(Simulate, TiersTellHowMuchWallTwoMapsShare) {
  SimulateOptions options = small();
  options.drift = 0.0;
  options.clutter = 0.0;
  options.width = 40.0;
  options.overlap = 0.8;
  const SimulatedPair much = simulate(options).pairs.at(0);
  EXPECT_EQ(much.tier, 'A');
  EXPECT_GE(much.shared_wall, 20.0);
  options.overlap = 0.05;
  const Simulation apart = simulate(options);
  for (const SimulatedPair& pair : apart.pairs) {
    EXPECT_NE(pair.tier, 'A');
    EXPECT_LT(pair.shared_wall, much.shared_wall);
  }
}

TEST(Simulate, NoOverlapMakesStrangers) {
  SimulateOptions options = small();
  options.width = 50.0;
  options.overlap = 0.0;
  const Simulation simulation = simulate(options);
  EXPECT_EQ(simulation.pairs.size(), 0U);
  EXPECT_LT(simulation.overlap, 0.01);
}

TEST(Simulate, DriftBendsMapsAndWidensTheTolerance) {
  double straight = 0.0, bent = 0.0, tolerance = 0.0;
  const int seeds = test::repeats(4, 1);
  for (int seed = 1; seed <= seeds; ++seed) {
    SimulateOptions options = small();
    options.width = 40.0;
    options.seed = static_cast<std::uint64_t>(seed);
    options.overlap = 0.6;
    options.drift = 0.0;
    straight += simulate(options).maps.front().bend / seeds;
    options.drift = 2.0;
    const Simulation simulation = simulate(options);
    bent += simulation.maps.front().bend / seeds;
    tolerance += simulation.pairs.front().tolerance / seeds;
  }
  EXPECT_LT(straight, 0.03);
  EXPECT_GT(bent, 0.2);
  EXPECT_GT(tolerance, 0.6);
}

TEST(Simulate, ASeedGivesTheSameMapsForAnyNumberOfThreads) {
  SimulateOptions options = small();
  options.robots = 3;
  options.overlap = 0.3;
  options.threads = 1;
  const Simulation one = simulate(options);
  options.threads = 4;
  const Simulation four = simulate(options);
  ASSERT_EQ(one.maps.size(), four.maps.size());
  for (std::size_t i = 0; i < one.maps.size(); ++i) {
    EXPECT_EQ(one.maps[i].grid.cells, four.maps[i].grid.cells);
    EXPECT_EQ(one.maps[i].T_building_map, four.maps[i].T_building_map);
  }
  options.seed = 4;
  EXPECT_NE(simulate(options).maps[0].grid.cells, one.maps[0].grid.cells);
}

TEST(Simulate, ClutterDiffersFromVisitToVisit) {
  SimulateOptions options = small(BuildingKind::hall);
  options.drift = 0.0;
  const auto met = [&](double clutter) {
    options.clutter = clutter;
    const Simulation simulation = simulate(options);
    return test::walls_met(simulation.maps[0].grid, simulation.maps[1].grid,
                           simulation.pairs[0].T_fixed_moving, 0.15);
  };
  EXPECT_GT(met(0.0), 0.95);
  EXPECT_LT(met(4.0), 0.95);
}

TEST(Simulate, RobotsStartWhereTheyAreToldTo) {
  SimulateOptions options = small(BuildingKind::hall);
  options.starts = {{3.0, 8.0}, {20.0, 8.0}};
  options.longest_way = 3.0;
  const Simulation simulation = simulate(options);
  for (std::size_t i = 0; i < 2; ++i) {
    const SE2& start = simulation.maps[i].path.front();
    EXPECT_LT(std::hypot(start.x - options.starts[i].x, start.y - options.starts[i].y), 0.6);
    // The map's origin is the start.
    const Point2 origin = simulation.maps[i].T_building_map * Point2{0.0, 0.0};
    EXPECT_LT(std::hypot(start.x - origin.x, start.y - origin.y), 0.3);
  }
}

TEST(Simulate, StepsAreTheMapAsItGrew) {
  SimulateOptions options;
  options.width = 20.0;
  options.height = 12.0;
  options.robots = 1;
  options.drift = 0.0;
  const Simulation once = simulate(options);
  EXPECT_TRUE(once.maps[0].earlier.empty());
  options.steps = 4;
  const SimulatedMap map = simulate(options).maps[0];
  EXPECT_EQ(map.grid.cells, once.maps[0].grid.cells);
  ASSERT_EQ(map.earlier.size(), 3u);
  std::size_t known = 0;
  for (const OccupancyGrid& step : map.earlier) {
    const std::size_t more = count_cells(step).known();
    EXPECT_GT(more, known);
    known = more;
    // In the same frame: what was drawn stays, but for what was drawn over.
    const internal::AgreementCounts counts = internal::count_agreement(map.grid, step, {});
    EXPECT_GT(counts.acceptance_index(), 0.98);
    EXPECT_GT(static_cast<double>(counts.both_known()), 0.95 * static_cast<double>(more));
  }
  EXPECT_GT(count_cells(map.grid).known(), known);
  options.steps = 0;
  EXPECT_THROW(simulate(options), std::invalid_argument);
}

TEST(Simulate, RobotsThatSetOffBackToBackPart) {
  SimulateOptions options = small(BuildingKind::hall);
  options.clutter = 0.0;
  options.starts = {{12.0, 8.0}, {12.0, 8.0}};
  options.sensor.field_of_view = std::numbers::pi;
  options.sensor.range = 6.0;
  const double together = simulate(options).overlap;
  options.headings = {0.0, std::numbers::pi};
  const Simulation simulation = simulate(options);
  EXPECT_LT(simulation.overlap, 0.8 * together);
  for (std::size_t i = 0; i < 2; ++i) {
    const std::vector<SE2>& path = simulation.maps[i].path;
    EXPECT_DOUBLE_EQ(path.front().theta, options.headings[i]);
    const double sign = i == 0 ? 1.0 : -1.0;
    for (const SE2& pose : path) EXPECT_GT(sign * (pose.x - path.front().x), -2.0) << i;
  }
}

TEST(SimulateWay, ScansAlongTheWay) {
  const SimulateOptions options = small();
  const Building hall = make_building(BuildingKind::bare, 24.0, 16.0, 5);
  const std::vector<Point2> way{{10.0, 8.0}, {14.0, 8.0}, {14.0, 9.0}};
  const SimulatedMap map = simulate_way(hall, way, options);
  ASSERT_EQ(map.path.size(), 11u);  // every half metre of 5 m, and the end
  EXPECT_EQ(map.path.front(), (SE2{10.0, 8.0, 0.0}));
  EXPECT_EQ(map.path[8], (SE2{14.0, 8.0, 0.5 * std::numbers::pi}));
  EXPECT_EQ(map.path.back(), (SE2{14.0, 9.0, 0.5 * std::numbers::pi}));
  const Point2 start = map.T_building_map * Point2{0.0, 0.0};
  EXPECT_LT(std::hypot(start.x - 10.0, start.y - 8.0), 0.3);
  EXPECT_EQ(map.grid.cells, simulate_way(hall, way, options).grid.cells);

  const std::vector<Point2> stays{{10.0, 8.0}};
  EXPECT_EQ(simulate_way(hall, stays, options).path.size(), 1u);
}

TEST(SimulateWay, RefusesWaysThatCannotBe) {
  const SimulateOptions options = small();
  const Building hall = make_building(BuildingKind::bare, 24.0, 16.0, 5);
  const auto go = [&](const std::vector<Point2>& way) { simulate_way(hall, way, options); };
  EXPECT_THROW(go({}), std::invalid_argument);
  EXPECT_THROW(go({{10.0, 8.0}, {100.0, 8.0}}), std::invalid_argument);  // through the outer wall
  EXPECT_THROW(go({{-20.0, 8.0}}), std::invalid_argument);
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(go({{10.0, 8.0}, {kNaN, 8.0}}), std::invalid_argument);
  EXPECT_THROW(go({{kNaN, kNaN}}), std::invalid_argument);
  Building open = hall;  // no wall is in the way
  open.edges.erase(std::remove_if(open.edges.begin(), open.edges.end(),
                                  [](const Edge& edge) { return edge.a.x > 23.0 && edge.b.x > 23.0; }),
                   open.edges.end());
  const std::vector<Point2> far{{10.0, 8.0}, {1e12, 8.0}};
  EXPECT_THROW(simulate_way(open, far, options), std::invalid_argument);
}

TEST(SimulateWay, APlaceTwiceIsAPlaceOnce) {
  const SimulateOptions options = small();
  const Building hall = make_building(BuildingKind::bare, 24.0, 16.0, 5);
  const std::vector<Point2> once{{10.0, 8.0}, {14.0, 8.0}};
  const std::vector<Point2> twice{{10.0, 8.0}, {10.0, 8.0}, {14.0, 8.0}, {14.0, 8.0}};
  EXPECT_EQ(simulate_way(hall, twice, options).path, simulate_way(hall, once, options).path);
  const std::vector<Point2> stays{{10.0, 8.0}, {10.0, 8.0}};
  EXPECT_EQ(simulate_way(hall, stays, options).path, (std::vector<SE2>{{10.0, 8.0, 0.0}}));
}

TEST(Simulate, MapsOfTooManyCellsAreRefused) {
  SimulateOptions options = small(BuildingKind::corridor);
  options.robots = 1;
  options.width = 500.0;
  options.height = 8.0;
  options.resolution = 0.01;
  options.sensor.range = 200.0;  // the map could be 400 m long both ways
  options.longest_way = 1.0;
  EXPECT_THROW(simulate(options), std::invalid_argument);
}

TEST(Simulate, SparseAndDenseSensorsAndMuchDriftStillGiveMapsAndATruth) {
  for (const BuildingKind kind :
       {BuildingKind::corridor, BuildingKind::arena, BuildingKind::maze, BuildingKind::bare}) {
    for (const auto& [step, range] : {std::pair{4.0, 3.0}, std::pair{0.25, 30.0}}) {
      SCOPED_TRACE(std::string(name_of(kind)) + " " + std::to_string(range));
      SimulateOptions options = small(kind);
      options.sensor.angular_step = step / 180.0 * std::numbers::pi;
      options.sensor.range = range;
      options.longest_way = 30.0;
      options.drift = 3.5;
      const Simulation simulation = simulate(options);
      for (const SimulatedMap& map : simulation.maps) {
        const double cell = map.grid.resolution * map.grid.resolution;
        EXPECT_GT(static_cast<double>(count_cells(map.grid).known()) * cell, 10.0);
        EXPECT_GT(map.bend, 0.01);
        EXPECT_LT(map.bend, 2.0);
      }
      for (const SimulatedPair& pair : simulation.pairs) EXPECT_LT(pair.tolerance, 6.0);
    }
  }
}

TEST(Simulate, RefusesWhatCannotBe) {
  const auto refused = [](auto change) {
    SimulateOptions options = small();
    change(options);
    EXPECT_THROW(simulate(options), std::invalid_argument);
  };
  static constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  refused([](auto& o) { o.robots = 0; });
  refused([](auto& o) { o.overlap = 1.1; });
  refused([](auto& o) { o.overlap = kNaN; });
  refused([](auto& o) { o.overlap = 0.5, o.robots = 1; });
  refused([](auto& o) { o.overlap = 0.9, o.starts = {{2.0, 8.0}, {22.0, 8.0}}, o.longest_way = 2.0; });
  refused([](auto& o) { o.starts = {{-5.0, 8.0}, {22.0, 8.0}}; });
  refused([](auto& o) { o.starts = {{2.0, 8.0}}; });
  refused([](auto& o) { o.starts = {{kNaN, 8.0}, {22.0, 8.0}}; });
  refused([](auto& o) { o.starts = {{2.0, 8.0}, {kNaN, kNaN}}; });
  refused([](auto& o) { o.headings = {0.0}; });
  refused([](auto& o) { o.headings = {0.0, kNaN}; });
  refused([](auto& o) { o.width = 3.0; });
  refused([](auto& o) { o.robot_radius = 4.9; });
  refused([](auto& o) { o.drift = -0.1; });
  refused([](auto& o) { o.clutter = kNaN; });
  refused([](auto& o) { o.resolution = 0.0; });
  refused([](auto& o) { o.longest_way = -1.0; });
  refused([](auto& o) { o.sensor.noise = -0.1; });
  refused([](auto& o) { o.sensor.range = 0.0; });
  refused([](auto& o) { o.sensor.missed_share = 1.5; });
  refused([](auto& o) { o.sensor.angular_step = 0.0; });
  refused([](auto& o) { o.sensor.field_of_view = 7.0; });
}

}  // namespace
}  // namespace gridmerge
