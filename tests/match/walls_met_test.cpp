// SPDX-License-Identifier: Apache-2.0
#include "gridmerge/match/walls_met.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "support/building.hpp"

namespace gridmerge {
namespace {

constexpr double kCell = 0.1;

/// The same map, drawn by a robot whose frame shears by `metres` over the map's height: no rigid pose fits.
OccupancyGrid bend(const OccupancyGrid& map, double metres) {
  OccupancyGrid bent = map;
  for (int row = 0; row < map.height; ++row) {
    const int shift =
        static_cast<int>(std::lround(metres / map.resolution * (row - 0.5 * map.height) / map.height));
    for (int column = 0; column < map.width; ++column) {
      const int from = column - shift;
      bent.at(column, row) = from >= 0 && from < map.width ? map.at(from, row) : Cell::unknown;
    }
  }
  return bent;
}

WallsMet measure(const OccupancyGrid& fixed, const OccupancyGrid& moving, const SE2& T_cells = {}) {
  const WallMap moving_walls = make_wall_map(moving, kCell);
  return measure_walls_met(make_wall_map(fixed, kCell), WallPatches(moving_walls), T_cells);
}

TEST(WallsMet, AreAllOfThemWhereAMapLiesOnItself) {
  const OccupancyGrid map = test::draw_building(1);
  const WallsMet met = measure(map, map);
  EXPECT_DOUBLE_EQ(met.rigidly, 1.0);
  EXPECT_DOUBLE_EQ(met.locally, 1.0);
}

TEST(WallsMet, OfABentMapMeetPatchByPatch) {
  const OccupancyGrid map = test::draw_building(1);
  const WallsMet met = measure(map, bend(map, 1.6));
  EXPECT_LT(met.rigidly, 0.75);
  EXPECT_GT(met.locally, 0.85);
}

TEST(WallsMet, OfAnotherBuildingDoNot) {
  const WallsMet met = measure(test::draw_building(1), test::draw_building(2));
  EXPECT_LT(met.rigidly, 0.6);
  EXPECT_LT(met.locally, 0.75);
}

TEST(WallsMet, DoNotDependOnWhichMapIsFixed) {
  const OccupancyGrid map = test::draw_building(1);
  const OccupancyGrid bent = bend(map, 1.0);
  const SE2 T{3.0, -2.0, 0.02};
  EXPECT_NEAR(measure(map, bent, T).rigidly, measure(bent, map, inverse(T)).rigidly, 1e-3);
}

TEST(WallsMet, AreNoneWhereTheMapsLieApart) {
  const OccupancyGrid map = test::draw_building(1);
  const WallsMet met = measure(map, map, {5000.0, 0.0, 0.0});
  EXPECT_EQ(met.rigidly, 0.0);
  EXPECT_EQ(met.locally, 0.0);
}

}  // namespace
}  // namespace gridmerge
