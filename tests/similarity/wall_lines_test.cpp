// SPDX-License-Identifier: Apache-2.0
#include "similarity/wall_lines.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

namespace gridmerge {

using namespace internal;
namespace {

constexpr int kSide = 160;

void draw_wall(OccupancyGrid& map, int x0, int y0, int x1, int y1) {
  for (int y = y0; y <= y1; ++y) {
    for (int x = x0; x <= x1; ++x) map.at(x, y) = Cell::occupied;
  }
}

/// The lower left corner of a room.
OccupancyGrid corner() {
  OccupancyGrid map = make_grid(kSide, kSide, 0.05);
  for (int y = 20; y < kSide; ++y) {
    for (int x = 20; x < kSide; ++x) map.at(x, y) = Cell::free;
  }
  draw_wall(map, 20, 20, kSide - 1, 20);
  draw_wall(map, 20, 20, 20, kSide - 1);
  return map;
}

double lines_of(const OccupancyGrid& map) {
  const LikelihoodField walls = make_likelihood_field(map, map.resolution);
  return measure_wall_support(walls, walls, {}).lines;
}

TEST(WallLines, ACornerHasTwo) {
  EXPECT_NEAR(lines_of(corner()), 2.0, 0.2);
}

TEST(WallLines, ARoomHasFour) {
  OccupancyGrid room = corner();
  draw_wall(room, 20, kSide - 1, kSide - 1, kSide - 1);
  draw_wall(room, kSide - 1, 20, kSide - 1, kSide - 1);
  EXPECT_NEAR(lines_of(room), 4.0, 0.3);
}

TEST(WallLines, EveryFurtherPieceOfWallAdds) {
  OccupancyGrid map = corner();
  double last = lines_of(map);
  for (int i = 0; i < 3; ++i) {
    draw_wall(map, 50 + 30 * i, 40 + 25 * i, 52 + 30 * i, 80 + 25 * i);
    const double lines = lines_of(map);
    EXPECT_GT(lines, last + 0.5);
    last = lines;
  }
}

TEST(WallLines, DoNotDependOnThePose) {
  const OccupancyGrid map = corner();
  const LikelihoodField walls = make_likelihood_field(map, map.resolution);
  OccupancyGrid elsewhere = map;
  elsewhere.origin = {4.0, -3.0, 1.0};
  const LikelihoodField other = make_likelihood_field(elsewhere, map.resolution);
  EXPECT_EQ(measure_wall_support(walls, other, {}).lines, measure_wall_support(walls, walls, {}).lines);
}

TEST(WallSupport, SpreadsAsFarAsItsNarrowSide) {
  OccupancyGrid corridor = make_grid(kSide, kSide, 0.05);
  for (int y = 60; y < 100; ++y) {
    for (int x = 0; x < kSide; ++x) corridor.at(x, y) = Cell::free;
  }
  draw_wall(corridor, 0, 60, kSide - 1, 60);
  draw_wall(corridor, 0, 99, kSide - 1, 99);
  const LikelihoodField walls = make_likelihood_field(corridor, 0.05);
  const WallSupport support = measure_wall_support(walls, walls, {});
  EXPECT_NEAR(support.spread, 19.5, 1.5);  // two walls 39 cells apart
  EXPECT_GT(support.met, 250.0);
  EXPECT_EQ(measure_wall_support(walls, walls, {1000.0, 0.0, 0.0}).met, 0.0);
}

TEST(WallLines, WallsThatDoNotMeetAreNone) {
  const LikelihoodField walls = make_likelihood_field(corner(), 0.05);
  EXPECT_EQ(measure_wall_support(walls, walls, {1000.0, 0.0, 0.0}).lines, 0.0);
  EXPECT_EQ(measure_wall_support(walls, walls, {25.0, 25.0, 0.0}).lines, 0.0);
  const LikelihoodField empty = make_likelihood_field(make_grid(30, 30, 0.05, {}, Cell::free), 0.05);
  EXPECT_EQ(measure_wall_support(walls, empty, {}).lines, 0.0);
}

/// A straight wall that is seen from above alone, 100 cells long.
LikelihoodField one_wall() {
  OccupancyGrid map = make_grid(kSide, kSide, 0.05);
  for (int y = 40; y < 120; ++y) {
    for (int x = 30; x < 130; ++x) map.at(x, y) = Cell::free;
  }
  draw_wall(map, 30, 40, 129, 40);
  return make_likelihood_field(map, 0.05);
}

TEST(WallSupport, WallsMeetUpToFourCellsApart) {
  const LikelihoodField wall = one_wall();
  EXPECT_NEAR(measure_wall_support(wall, wall, {0.0, 4.0, 0.0}).met, 100.0, 6.0);
  EXPECT_LT(measure_wall_support(wall, wall, {0.0, 5.0, 0.0}).met, 6.0);
}

/// The wall, turned about its middle by parts of a turn.
double met_when_turned(int steps) {
  const LikelihoodField wall = one_wall();
  const double theta = 2.0 * std::numbers::pi * steps / kDirections;
  Point2 middle;
  for (const WallPoint& point : wall.walls)
    middle = {middle.x + point.position.x / static_cast<double>(wall.walls.size()),
              middle.y + point.position.y / static_cast<double>(wall.walls.size())};
  const Point2 moved = SE2{0.0, 0.0, theta} * middle;
  return measure_wall_support(wall, wall, {middle.x - moved.x, middle.y - moved.y, theta}).met;
}

TEST(WallSupport, WallsMeetThatFaceTheSameWayUpToSixPartsOfATurn) {
  EXPECT_GT(met_when_turned(6), 4.0);
  EXPECT_GT(met_when_turned(-6), 4.0);
  EXPECT_EQ(met_when_turned(7), 0.0);
  EXPECT_EQ(met_when_turned(-7), 0.0);
  EXPECT_EQ(met_when_turned(16), 0.0);  // seen from behind
}

/// Walls of so many cells, each seen from above alone, far from each other.
double lines_of_pieces(const std::vector<int>& lengths) {
  OccupancyGrid map = make_grid(60, 40 * static_cast<int>(lengths.size()), 0.05);
  for (int i = 0; i < static_cast<int>(lengths.size()); ++i) {
    for (int y = 0; y < 12; ++y) {
      for (int x = 10; x < 10 + lengths[static_cast<std::size_t>(i)]; ++x)
        map.at(x, 40 * i + 10 + y) = y == 0 ? Cell::occupied : Cell::free;
    }
  }
  const LikelihoodField walls = make_likelihood_field(map, 0.05);
  return measure_wall_support(walls, walls, {}).lines;
}

TEST(WallLines, OfSixPointsIsTheShortest) {
  // The two ends of a piece face other ways.
  EXPECT_EQ(lines_of_pieces({7}), 0.0);
  EXPECT_EQ(lines_of_pieces({8}), 1.0);
}

TEST(WallLines, AreTheExponentialOfTheEntropyOfTheirLengths) {
  EXPECT_NEAR(lines_of_pieces({20, 20}), 2.0, 1e-9);
  EXPECT_NEAR(lines_of_pieces({30, 10}), std::exp(-0.75 * std::log(0.75) - 0.25 * std::log(0.25)), 1e-9);
  EXPECT_NEAR(lines_of_pieces(std::vector<int>(24, 20)), 24.0, 1e-9);
  EXPECT_NEAR(lines_of_pieces(std::vector<int>(26, 20)), 24.0, 1e-9);  // no more are counted
}

/// Two walls that are seen from above, one beside the other and so much higher.
double lines_of_a_step(int cells) {
  OccupancyGrid map = make_grid(kSide, kSide, 0.05);
  for (int y = 40; y < 120; ++y) {
    for (int x = 20; x < 140; ++x) {
      const int wall = x < 80 ? 40 : 40 + cells;
      if (y >= wall) map.at(x, y) = y == wall ? Cell::occupied : Cell::free;
    }
  }
  const LikelihoodField walls = make_likelihood_field(map, 0.05);
  return measure_wall_support(walls, walls, {}).lines;
}

TEST(WallLines, AStepOfAFewCellsIsNoSecondLine) {
  EXPECT_EQ(lines_of_a_step(3), 1.0);
  EXPECT_GT(lines_of_a_step(12), 1.8);
}

}  // namespace
}  // namespace gridmerge
