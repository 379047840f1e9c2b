// SPDX-License-Identifier: Apache-2.0
#include "match/walls_met.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "support/building.hpp"

namespace gridmerge {

using namespace internal;
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
  const LikelihoodField moving_walls = make_likelihood_field(moving, kCell);
  return measure_walls_met(make_likelihood_field(fixed, kCell), WallPatches(moving_walls), T_cells);
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

/// A room of 8 m with a post of two cells in it, or without.
OccupancyGrid room(bool with_post, int post_column = 40) {
  OccupancyGrid grid = make_grid(90, 90, kCell);
  for (int row = 5; row < 85; ++row) {
    for (int column = 5; column < 85; ++column) {
      const bool edge = row == 5 || row == 84 || column == 5 || column == 84;
      grid.at(column, row) = edge ? Cell::occupied : Cell::free;
    }
  }
  if (!with_post) return grid;
  for (int row = 30; row < 36; ++row)
    for (int column = post_column; column < post_column + 6; ++column) grid.at(column, row) = Cell::occupied;
  return grid;
}

TEST(WallsMet, ThingsThatStandAloneAreCountedByThemselves) {
  const WallsMet same = measure(room(true), room(true));
  EXPECT_GT(same.seen_things, 0.0);
  EXPECT_EQ(same.things_met, 1.0);
  const WallsMet moved = measure(room(true), room(true, 60));
  EXPECT_EQ(moved.seen_things, same.seen_things);
  EXPECT_EQ(moved.things_met, 0.0);
  EXPECT_GT(moved.rigidly, 0.85);  // of the walls, nearly all
  EXPECT_LT(moved.rigidly, 1.0);
  EXPECT_EQ(measure(room(false), room(false)).seen_things, 0.0);
  const WallsMet one_sided = measure(room(true), room(false));
  EXPECT_NEAR(one_sided.seen_things, 0.5 * same.seen_things, 1e-9);
  EXPECT_EQ(one_sided.things_met, 0.0);
}

TEST(WallsMet, AWallSeenFromBehindIsNotMet) {
  const OccupancyGrid left = make_grid(60, 60, kCell);
  OccupancyGrid from_left = left, from_right = left;
  for (int row = 0; row < 60; ++row) {
    for (int column = 0; column < 30; ++column) {
      from_left.at(column, row) = Cell::free;
      from_right.at(59 - column, row) = Cell::free;
    }
    from_left.at(30, row) = from_right.at(30, row) = Cell::occupied;
  }
  const LikelihoodField a = make_likelihood_field(from_left, kCell),
                        b = make_likelihood_field(from_right, kCell);
  const SE2 T = inverse(a.T_map_grid) * b.T_map_grid;
  const WallsMet met = measure_walls_met(a, WallPatches(b), {T.x / kCell, T.y / kCell, T.theta});
  EXPECT_LT(met.rigidly, 0.1);
  EXPECT_EQ(measure_walls_met(a, WallPatches(a), {}).rigidly, 1.0);
}

// Most of the second map lies where the first has seen nothing. Its patches are bent by half a metre: they
// meet what they know in common, and are not drawn away from it by what is unseen.
TEST(WallsMet, WhatTheOtherMapHasNotSeenNeitherDrawsNorHolds) {
  const OccupancyGrid building = test::draw_building(1);
  const OccupancyGrid part = test::map_part(building, {0, 0, 7, 13}, {});
  const LikelihoodField fixed = make_likelihood_field(part, kCell),
                        moving = make_likelihood_field(bend(building, 1.0), kCell);
  const SE2 T = inverse(fixed.T_map_grid) * moving.T_map_grid;
  const SE2 T_cells{T.x / kCell, T.y / kCell, T.theta};
  const WallsMet met = measure_walls_met(fixed, WallPatches(moving), T_cells);
  EXPECT_GT(met.locally, met.rigidly + 0.1);
  EXPECT_GT(met.locally, 0.8);
}

TEST(WallsMet, AreNoneWhereTheMapsLieApart) {
  const OccupancyGrid map = test::draw_building(1);
  const WallsMet met = measure(map, map, {5000.0, 0.0, 0.0});
  EXPECT_EQ(met.rigidly, 0.0);
  EXPECT_EQ(met.locally, 0.0);
}

}  // namespace
}  // namespace gridmerge
