// SPDX-License-Identifier: Apache-2.0
// What a simulation says of the places that its maps share.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>
#include <vector>

#include "gridmerge/evaluate/evaluate.hpp"
#include "gridmerge/simulate/simulate.hpp"
#include "simulate/walls_met.hpp"

namespace gridmerge {
namespace {

/// Robots that go a few metres each, so that some share much, some little and some nothing.
SimulateOptions short_ways(std::uint64_t seed) {
  SimulateOptions options;
  options.kind = BuildingKind::apartment;
  options.width = 30.0;
  options.height = 16.0;
  options.robots = 5;
  options.longest_way = 6.0;
  options.scan_every = 0.5;
  options.sensor.range = 5.0;
  options.sensor.angular_step = 0.0175;
  options.drift = 0.0;
  options.resolution = 0.1;
  options.seed = seed;
  return options;
}

TEST(SharedPlaces, TiersAreOfTheSharedWallAndOfTheShareThatMatches) {
  std::set<char> tiers;
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    SimulateOptions options = short_ways(seed);
    if (seed % 2 == 0) options.longest_way = 25.0;
    const Simulation simulation = simulate(options);
    for (const SimulatedPair& pair : simulation.pairs) {
      const OccupancyGrid &fixed = simulation.maps[pair.fixed].grid,
                          &moving = simulation.maps[pair.moving].grid;
      const test::MetWalls walls = test::count_met_walls(fixed, moving, pair.T_fixed_moving, 2);
      // A cell whose centre lies on the edge of another one may be in either.
      EXPECT_NEAR(pair.shared_wall, 0.1 * walls.known, 0.101);
      const double match = walls.known > 0 ? static_cast<double>(walls.met) / walls.known : 0.0;
      const auto is_near = [&](double metres, double share) {
        return std::abs(pair.shared_wall - metres) < 0.3 || std::abs(match - share) < 0.01;
      };
      tiers.insert(pair.tier);
      if (is_near(20.0, 0.8) || is_near(7.5, 0.6)) continue;
      const bool is_a = pair.shared_wall >= 20.0 && match >= 0.8;
      const bool is_b = pair.shared_wall >= 7.5 && match >= 0.6;
      EXPECT_EQ(pair.tier, is_a ? 'A' : is_b ? 'B' : 'C') << pair.shared_wall << " m, " << match;
    }
  }
  EXPECT_EQ(tiers, (std::set{'A', 'B', 'C'}));
}

TEST(SharedPlaces, OverlapIsTheMeanOfTheLargestOfEachMap) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    const Simulation simulation = simulate(short_ways(seed));
    std::vector<double> largest(simulation.maps.size(), 0.0);
    std::set<std::pair<std::size_t, std::size_t>> listed;
    for (const SimulatedPair& pair : simulation.pairs) {
      EXPECT_LT(pair.fixed, pair.moving);
      EXPECT_TRUE(listed.emplace(pair.fixed, pair.moving).second);
      EXPECT_GT(pair.overlap, 0.0);
      EXPECT_LE(pair.overlap, 1.0);
      EXPECT_GE(pair.tolerance, kMinTolerance);
      for (const std::size_t map : {pair.fixed, pair.moving})
        largest[map] = std::max(largest[map], pair.overlap);
    }
    double mean = 0.0;
    for (const double overlap : largest) mean += overlap / static_cast<double>(largest.size());
    EXPECT_NEAR(simulation.overlap, mean, 1e-12);
    for (const auto& [a, b] : simulation.strangers) {
      EXPECT_LT(a, b);
      EXPECT_TRUE(listed.emplace(a, b).second) << "and is no pair";
    }
  }
}

/// Bent maps have one transform for what they share and another one for all of them: either may be found.
TEST(SharedPlaces, TheToleranceHoldsBothTransformsOfBentMaps) {
  double most = 0.0;
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    SimulateOptions options = short_ways(seed);
    options.longest_way = 25.0;
    options.drift = 4.0;
    const Simulation simulation = simulate(options);
    for (const SimulatedPair& pair : simulation.pairs) {
      const SimulatedMap &fixed = simulation.maps[pair.fixed], &moving = simulation.maps[pair.moving];
      const double apart = rms_displacement(moving.grid, pair.T_fixed_moving,
                                            inverse(fixed.T_building_map) * moving.T_building_map);
      // Over known cells, which are not quite the places that were drawn.
      EXPECT_GT(pair.tolerance, 0.3 + 0.7 * apart);
      most = std::max(most, apart);
    }
  }
  EXPECT_GT(most, 1.0);
}

TEST(SharedPlaces, ARobotThatStandsWhereAnotherOneDidSharesAllWithIt) {
  SimulateOptions options = short_ways(4);
  options.kind = BuildingKind::bare;
  options.robots = 2;
  options.clutter = 0.0;
  options.longest_way = 0.1;
  options.sensor = {6.283185307179586, 0.0175, 5.0, 0.5, 0.0, 0.0, 0.0};
  options.starts = {{15.0, 8.0}, {15.0, 8.0}};
  const Simulation simulation = simulate(options);
  ASSERT_EQ(simulation.pairs.size(), 1u);
  EXPECT_GT(simulation.pairs[0].overlap, 0.95);
  EXPECT_NEAR(simulation.pairs[0].tolerance, kMinTolerance, 1e-9);
  EXPECT_TRUE(simulation.strangers.empty());
}

TEST(Progress, GoesUpToOne) {
  for (const bool has_overlap : {false, true}) {
    SimulateOptions options = short_ways(2);
    options.robots = 2;
    options.longest_way = 0.0;
    if (has_overlap) options.overlap = 0.5;
    std::vector<double> told;
    options.progress = [&](double share) { told.push_back(share); };
    simulate(options);
    ASSERT_FALSE(told.empty());
    EXPECT_EQ(told.back(), 1.0);
    EXPECT_TRUE(std::is_sorted(told.begin(), told.end()));
    EXPECT_GT(told.front(), 0.0);
  }
}

}  // namespace
}  // namespace gridmerge
