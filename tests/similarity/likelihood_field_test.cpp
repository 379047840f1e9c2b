// SPDX-License-Identifier: Apache-2.0
#include "similarity/likelihood_field.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <numbers>
#include <numeric>
#include <random>
#include <utility>

#include "random_grid.hpp"

namespace gridmerge {

using namespace internal;
namespace {

/// Centre of a cell of the likelihood field, in the map frame.
Point2 centre_of(const LikelihoodField& map, int x, int y) {
  return map.T_map_grid * Point2{(x + 0.5) * map.cell, (y + 0.5) * map.cell};
}

TEST(LikelihoodField, DistancesAreWithinEightPercentOfTheEuclideanOnes) {
  const OccupancyGrid grid = test::random_grid(3, 40, 30);
  const LikelihoodField map = make_likelihood_field(grid, grid.resolution);
  for (int y = 1; y + 1 < map.height; ++y) {
    for (int x = 1; x + 1 < map.width; ++x) {
      const int bin = map.places[static_cast<std::size_t>(y) * map.width + x].distance;
      if (bin == kUnseen) continue;
      double nearest = std::numeric_limits<double>::infinity();
      for (int row = 0; row < grid.height; ++row) {
        for (int column = 0; column < grid.width; ++column) {
          if (grid.at(column, row) != Cell::occupied) continue;
          const Point2 p = centre_of(map, x, y);
          const Point2 wall = grid.cell_centre(column, row);
          nearest = std::min(nearest, std::hypot(p.x - wall.x, p.y - wall.y) / map.cell);
        }
      }
      if (bin == kDistanceBins - 1) {
        EXPECT_GE(nearest, 0.92 * (kDistanceBins - 1.5));
      } else {
        EXPECT_NEAR(bin, nearest, 0.5 + 0.08 * nearest + 1e-9);
      }
    }
  }
}

/// The chamfer distance (3, 4) between two cells, in thirds of a cell.
int chamfer(int dx, int dy) {
  const int longer = std::max(std::abs(dx), std::abs(dy)), shorter = std::min(std::abs(dx), std::abs(dy));
  return 4 * shorter + 3 * (longer - shorter);
}

TEST(LikelihoodField, PlacesEqualTheDefinition) {
  std::mt19937 random(8);
  for (int run = 0; run < 40; ++run) {
    const int width = 1 + run, height = 1 + static_cast<int>(random() % 30);
    OccupancyGrid grid = make_grid(width, height, 0.05, {}, Cell::unknown);
    const auto known = 2 + random() % 60, walls = 2 + random() % 12;
    for (Cell& cell : grid.cells)
      if (random() % known == 0) cell = random() % walls == 0 ? Cell::occupied : Cell::free;
    const LikelihoodField map = make_likelihood_field(grid, grid.resolution);
    constexpr int kMargin = 4;
    ASSERT_EQ(map.width, width + 2 * kMargin);
    for (int y = 0; y < map.height; ++y) {
      for (int x = 0; x < map.width; ++x) {
        int to_known = 1000;
        for (int row = 0; row < height; ++row) {
          for (int column = 0; column < width; ++column)
            if (grid.at(column, row) != Cell::unknown)
              to_known = std::min(to_known, chamfer(column + kMargin - x, row + kMargin - y));
        }
        std::pair<int, int> nearest{60000, 0};  // distance and facing of a wall, the smaller facing of equals
        for (const WallPoint& wall : map.walls) {
          const int dx = static_cast<int>(wall.position.x) - x, dy = static_cast<int>(wall.position.y) - y;
          nearest = std::min(nearest, {chamfer(dx, dy), wall.facing});
        }
        const Place& place = map.places[map.index(x, y)];
        if (to_known > 6) {
          EXPECT_EQ(place.distance, kUnseen) << run << ": " << x << " " << y;
        } else {
          EXPECT_EQ(place.distance, std::min((nearest.first + 1) / 3, kDistanceBins - 1))
              << run << ": " << x << " " << y;
          EXPECT_EQ(place.facing, nearest.second) << run << ": " << x << " " << y;
        }
      }
    }
  }
}

TEST(LikelihoodField, APlaceIsThatOfItsCellAndNothingIsSeenOutside) {
  const LikelihoodField map = make_likelihood_field(test::random_grid(3, 12, 7), 0.1);
  ASSERT_NE(map.width, map.height);
  for (int y = 0; y < map.height; ++y) {
    for (int x = 0; x < map.width; ++x) {
      const Place& place = map.places[static_cast<std::size_t>(y) * map.width + x];
      for (const Point2& within : {Point2{0.0, 0.0}, Point2{0.999, 0.001}, Point2{0.5, 0.999}}) {
        const Place found = map.place_at({x + within.x, y + within.y});
        EXPECT_EQ(found.distance, place.distance);
        EXPECT_EQ(found.facing, place.facing);
      }
    }
  }
  // As if all of it were seen, so that what is outside does not look like the rim.
  LikelihoodField seen = map;
  for (Place& place : seen.places) place = {0, 0};
  const double width = map.width, height = map.height, nan = std::numeric_limits<double>::quiet_NaN();
  for (const Point2& outside : {Point2{-1e-9, 1.0}, Point2{1.0, -1e-9}, Point2{width, 1.0},
                                Point2{1.0, height}, Point2{1e300, 1.0}, Point2{nan, 1.0}, Point2{1.0, nan}})
    EXPECT_EQ(seen.place_at(outside).distance, kUnseen) << outside.x << " " << outside.y;
}

TEST(LikelihoodField, WallsKeepTheirPlaceInTheMapFrame) {
  OccupancyGrid grid = make_grid(30, 20, 0.05, {3.0, -2.0, 0.7}, Cell::free);
  grid.at(21, 13) = Cell::occupied;
  for (const double cell : {0.05, 0.1, 0.17}) {
    const LikelihoodField map = make_likelihood_field(grid, cell);
    ASSERT_EQ(map.walls.size(), 1U) << cell;
    const Point2 found =
        map.T_map_grid * Point2{map.walls[0].position.x * cell, map.walls[0].position.y * cell};
    EXPECT_NEAR(found.x, grid.cell_centre(21, 13).x, 1e-5);
    EXPECT_NEAR(found.y, grid.cell_centre(21, 13).y, 1e-5);
  }
}

TEST(LikelihoodField, OnlyKnownPlacesAndTheirSurroundingsAreSeen) {
  OccupancyGrid grid = make_grid(30, 30, 0.1);
  grid.at(10, 10) = Cell::free;
  grid.at(20, 20) = Cell::occupied;
  const LikelihoodField map = make_likelihood_field(grid, 0.1);
  int seen = 0;
  for (int y = 0; y < map.height; ++y) {
    for (int x = 0; x < map.width; ++x) {
      if (map.places[static_cast<std::size_t>(y) * map.width + x].distance == kUnseen) continue;
      ++seen;
      const Point2 p = centre_of(map, x, y);
      const double from_free = std::hypot(p.x - 1.05, p.y - 1.05);
      const double from_wall = std::hypot(p.x - 2.05, p.y - 2.05);
      EXPECT_LE(std::min(from_free, from_wall), 0.25);
    }
  }
  EXPECT_EQ(seen, 2 * 13);  // two discs of radius 2 cells
}

TEST(LikelihoodField, BackgroundIsADistributionWithoutZeros) {
  for (const OccupancyGrid& grid :
       {test::random_grid(1, 30, 40), make_grid(1, 1, 0.1), make_grid(5, 5, 1.0, {}, Cell::free)}) {
    const LikelihoodField map = make_likelihood_field(grid, grid.resolution);
    EXPECT_NEAR(std::accumulate(map.background.begin(), map.background.end(), 0.0), 1.0, 1e-12);
    for (const double share : map.background) EXPECT_GT(share, 0.0);
  }
}

TEST(LikelihoodField, CoarserCellsHoldTheCentroidOfTheirWalls) {
  OccupancyGrid grid = make_grid(8, 8, 0.1, {}, Cell::free);
  grid.at(4, 4) = Cell::occupied;
  grid.at(5, 4) = Cell::occupied;
  const LikelihoodField map = make_likelihood_field(grid, 0.4);
  ASSERT_EQ(map.walls.size(), 1U);
  const Point2 found = map.T_map_grid * Point2{map.walls[0].position.x * 0.4, map.walls[0].position.y * 0.4};
  EXPECT_NEAR(found.x, 0.5, 1e-6);
  EXPECT_NEAR(found.y, 0.45, 1e-6);
}

/// The direction [rad, grid frame] that a facing stands for.
double angle_of(std::uint8_t facing) {
  return 2.0 * std::numbers::pi * facing / kDirections;
}

TEST(LikelihoodField, WallsFaceTheirFreeSide) {
  OccupancyGrid grid = make_grid(30, 30, 0.1);
  for (int row = 0; row < 30; ++row) {
    for (int column = 0; column < 15; ++column) grid.at(column, row) = Cell::free;
    grid.at(15, row) = Cell::occupied;
  }
  const LikelihoodField map = make_likelihood_field(grid, 0.1);
  ASSERT_EQ(map.walls.size(), 30U);
  EXPECT_NEAR(angle_of(map.walls[15].facing), std::numbers::pi, 1e-9);
  // The places around take it over.
  const Point2 at = map.walls[15].position;
  for (const int dx : {-5, -1, 1}) {
    const std::size_t i = static_cast<std::size_t>(at.y) * map.width + static_cast<std::size_t>(at.x + dx);
    EXPECT_EQ(map.places[i].facing, map.walls[15].facing) << dx;
  }
}

TEST(LikelihoodField, AThinWallWithFloorOnBothSidesHasAnAxis) {
  OccupancyGrid grid = make_grid(31, 31, 0.1, {}, Cell::free);
  for (int row = 0; row < 31; ++row) grid.at(15, row) = Cell::occupied;
  const LikelihoodField upright = make_likelihood_field(grid, 0.1);
  ASSERT_TRUE(is_axis(upright.walls[15].facing));
  EXPECT_EQ(upright.walls[15].facing, kDirections);  // across it, along x
  for (int row = 0; row < 31; ++row) grid.at(15, row) = Cell::free;
  for (int i = 0; i < 31; ++i) grid.at(i, i) = Cell::occupied;
  const LikelihoodField diagonal = make_likelihood_field(grid, 0.1);
  ASSERT_TRUE(is_axis(diagonal.walls[15].facing));
  EXPECT_EQ(diagonal.walls[15].facing, kDirections + 3 * kAxes / 4);
}

TEST(LikelihoodField, APillarAndTheInsideOfAThickWallHaveNoAxis) {
  OccupancyGrid grid = make_grid(41, 41, 0.1, {}, Cell::free);
  grid.at(10, 10) = Cell::occupied;
  for (int row = 0; row < 41; ++row)
    for (int column = 24; column < 35; ++column) grid.at(column, row) = Cell::occupied;
  const LikelihoodField map = make_likelihood_field(grid, 0.1);
  for (const WallPoint& wall : map.walls) EXPECT_FALSE(is_axis(wall.facing)) << wall.position.x;
}

TEST(LikelihoodField, SmallThingsStandAloneAndWallsDoNot) {
  OccupancyGrid grid = make_grid(80, 80, 0.1, {}, Cell::free);
  for (int i = 0; i < 80; ++i) grid.at(i, 2) = Cell::occupied;    // a wall of 8 m
  for (int i = 30; i < 36; ++i) grid.at(i, 30) = Cell::occupied;  // a table
  for (int i = 3; i < 9; ++i) grid.at(60, i) = Cell::occupied;    // a cupboard against the wall
  grid.at(50, 60) = Cell::occupied;                               // a speck
  const LikelihoodField map = make_likelihood_field(grid, 0.1);
  int alone = 0;
  for (const WallPoint& wall : map.walls) {
    if (!wall.stands_alone) continue;
    ++alone;
    const Point2 at = map.T_map_grid * Point2{wall.position.x * map.cell, wall.position.y * map.cell};
    EXPECT_NEAR(at.y, 3.05, 1e-5);
  }
  EXPECT_EQ(alone, 6);
}

TEST(Turned, TurnsDirectionsByATurnAndAxesByHalfATurn) {
  EXPECT_EQ(turned(30, 5), 3);
  EXPECT_EQ(turned(kDirections + 14, 5), kDirections + 3);
  EXPECT_EQ(turned(kNoDirection, 5), kNoDirection);
  EXPECT_EQ(steps_of_turn(-std::numbers::pi / 2.0), 24);
  EXPECT_EQ(steps_of_turn(2.0 * std::numbers::pi - 1e-9), 0);
  for (int i = -5001; i <= 5001; ++i) {  // four turns each way
    const double theta = 2.0 * std::numbers::pi * i / 1250.1;
    const long steps = std::lround(32.0 * i / 1250.1);
    EXPECT_EQ(steps_of_turn(theta), ((steps % 32) + 32) % 32) << i;
  }
}

}  // namespace
}  // namespace gridmerge
