// SPDX-License-Identifier: Apache-2.0
// What the answer must not depend on, and places that look alike from several sides.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "grid/quarter_turned.hpp"
#include "gridmerge/grid/resample.hpp"
#include "gridmerge/match/match.hpp"
#include "match/hypotheses.hpp"
#include "support/building.hpp"

namespace gridmerge {
namespace {

/// What its own robot saw of the building, with a tenth of the walls missing.
OccupancyGrid worn(const OccupancyGrid& map, unsigned seed) {
  std::mt19937 random(seed);
  OccupancyGrid copy = map;
  for (Cell& cell : copy.cells) {
    if (cell == Cell::occupied && random() % 10 == 0) cell = Cell::free;
  }
  return copy;
}

struct Box {
  int left, bottom, right, top;
};

/// A walled square of 10 m with blocks that look the same from all four sides, and round pillars that do not.
OccupancyGrid draw_arena(int pillars) {
  constexpr int kSide = 200, kMargin = 10;
  constexpr std::array<Box, 5> kBlocks{
      {{20, 40, 24, 64}, {45, 18, 69, 22}, {70, 50, 74, 72}, {38, 82, 62, 86}, {85, 85, 105, 89}}};
  constexpr std::array<std::array<int, 2>, 4> kPillars{{{30, 150}, {100, 110}, {150, 20}, {172, 128}}};
  OccupancyGrid map = make_grid(kSide + 2 * kMargin, kSide + 2 * kMargin, 0.05);
  const auto at = [&](int x, int y) -> Cell& { return map.at(x + kMargin, y + kMargin); };
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) {
      const bool rim = std::min(std::min(x, y), kSide - 1 - std::max(x, y)) < 2;
      at(x, y) = rim ? Cell::occupied : Cell::free;
    }
  }
  for (const Box& block : kBlocks) {
    for (int y = block.bottom; y < block.top; ++y) {
      for (int x = block.left; x < block.right; ++x) {
        int u = x, v = y;
        for (int quarter = 0; quarter < 4; ++quarter) {
          at(u, v) = Cell::occupied;
          const int turned = kSide - 1 - v;
          v = u;
          u = turned;
        }
      }
    }
  }
  for (int i = 0; i < pillars; ++i) {
    for (int y = -4; y <= 4; ++y)
      for (int x = -4; x <= 4; ++x)
        if (x * x + y * y < 18) at(kPillars[i][0] + x, kPillars[i][1] + y) = Cell::occupied;
  }
  return map;
}

/// Without the corner that is nearest to (0, 0), or the one farthest from it.
OccupancyGrid without_corner(OccupancyGrid map, bool far_one) {
  for (int row = 0; row < map.height; ++row) {
    for (int column = 0; column < map.width; ++column) {
      const int x = far_one ? map.width - 1 - column : column, y = far_one ? map.height - 1 - row : row;
      if (x < 90 && y < 90) map.at(column, row) = Cell::unknown;
    }
  }
  return map;
}

TEST(Symmetric, AnArenaThatLooksTheSameFromFourSidesIsAmbiguous) {
  const OccupancyGrid arena = draw_arena(0);
  const MatchResult result =
      match(without_corner(worn(arena, 1), false), without_corner(worn(arena, 2), true));
  EXPECT_EQ(result.verdict, Verdict::refused);
  EXPECT_EQ(result.reason, Reason::ambiguous);
  EXPECT_GE(result.hypotheses.size(), 4U);
}

TEST(Symmetric, PillarsTellTheSidesOfAnArenaApartOrItIsRefused) {
  const OccupancyGrid arena = draw_arena(4);
  const MatchResult result =
      match(without_corner(worn(arena, 1), false), without_corner(worn(arena, 2), true));
  if (result.verdict == Verdict::accepted) {
    EXPECT_NEAR(result.T_fixed_moving.theta, 0.0, 0.01);
  } else {
    EXPECT_EQ(result.reason, Reason::ambiguous);
  }
}

/// An empty room: every second wall cell missing, as chance will have it.
OccupancyGrid draw_room(int width, int height, unsigned seed) {
  std::mt19937 random(seed);
  OccupancyGrid room = make_grid(width + 20, height + 20, 0.05);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const int rim = std::min(std::min(x, y), std::min(width - 1 - x, height - 1 - y));
      if (rim >= 1) room.at(x + 10, y + 10) = Cell::free;
      if (rim == 1 || ((rim == 0 || rim == 2) && random() % 2 == 0)) room.at(x + 10, y + 10) = Cell::occupied;
    }
  }
  return room;
}

TEST(Symmetric, AnEmptyRoomIsAmbiguousAndNeverTooLittle) {
  for (const auto& [width, height] : {std::array{300, 180}, std::array{200, 200}}) {
    const OccupancyGrid one = draw_room(width, height, 1), other = draw_room(width, height, 2);
    EXPECT_EQ(match(one, other).verdict, Verdict::refused);
    EXPECT_EQ(match(one, other).reason, Reason::ambiguous) << width;
  }
}

/// Every second wall cell of two rims is there by chance: no other place has as little against it.
TEST(Symmetric, AnEmptyRoomLiesOnItselfCellOnCell) {
  for (const auto& [width, height] : {std::array{300, 180}, std::array{200, 200}}) {
    const OccupancyGrid room = draw_room(width, height, 1);
    const MatchResult result = match(room, room);
    EXPECT_EQ(result.verdict, Verdict::accepted) << width;
    EXPECT_EQ(result.T_fixed_moving, SE2{}) << width;
  }
}

/// From farther away than cells are tried, walls have to climb first: of both ways to settle the better one
/// counts.
TEST(Symmetric, AnEmptyRoomSettlesOnItselfFromNearby) {
  for (unsigned seed = 1; seed <= 40; ++seed) {
    const PreparedMap room(draw_room(120, 80, seed));
    const internal::ComparedMaps maps(room, room);
    const internal::PoseJudge judge(maps);
    for (const SE2& start : {SE2{}, SE2{0.06, 0.06, 0.002}, SE2{0.15, 0.0, 0.0}, SE2{0.3, 0.2, 0.0}}) {
      const internal::Settled settled =
          judge.settle(judge.judge(internal::to_cells(start, maps.fixed_walls, maps.moving_walls)));
      EXPECT_EQ(settled.hypothesis.T_fixed_moving, SE2{}) << seed << ' ' << start.x << ' ' << start.y;
    }
  }
}

/// Many of the places that it could be in beside itself climb to it. They are one hypothesis, and cell on
/// cell.
TEST(Symmetric, WhatClimbsToOnePlaceInAnEmptyRoomIsOneHypothesis) {
  for (const unsigned seed : {5U, 15U, 42U, 58U}) {
    const OccupancyGrid room = draw_room(300, 180, seed);
    const MatchResult result = match(room, room);
    ASSERT_FALSE(result.hypotheses.empty());
    EXPECT_EQ(result.T_fixed_moving, SE2{}) << seed;
    for (std::size_t i = 1; i < result.hypotheses.size(); ++i) {
      const SE2& T = result.hypotheses[i].T_fixed_moving;
      if (std::abs(T.theta) < 0.1) {
        EXPECT_GT(std::hypot(T.x, T.y), 0.3) << seed << ' ' << i;
      }
    }
  }
}

/// Walls of one cell with floor on both sides, `border` cells inside the map.
OccupancyGrid draw_maze(int border) {
  constexpr int kSide = 200;
  OccupancyGrid maze = make_grid(kSide, kSide, 0.05, {}, Cell::free);
  const auto wall = [&](int x0, int y0, int x1, int y1) {
    for (int y = y0; y <= y1; ++y)
      for (int x = x0; x <= x1; ++x) maze.at(x, y) = Cell::occupied;
  };
  const int d = border, e = kSide - 1 - border;
  wall(d, d, e, d), wall(d, e, e, e), wall(d, d, d, e), wall(e, d, e, e);
  wall(60, d, 60, 75), wall(d, 100, 125, 100), wall(60, 100, 60, 145), wall(165, 45, 165, 155);
  wall(95, 150, 145, 150), wall(95, 150, 95, 180), wall(95, 180, 125, 180), wall(60, 45, 165, 45);
  return maze;
}

TEST(ThinWalls, AMazeLiesOnItselfWhereverItsBorderIs) {
  for (const int border : {2, 3, 5}) {
    const OccupancyGrid maze = draw_maze(border);
    const MatchResult result = match(maze, maze);
    EXPECT_EQ(result.verdict, Verdict::accepted) << border << ' ' << result.probability;
    EXPECT_EQ(result.T_fixed_moving, SE2{}) << border;
  }
}

TEST(Painted, BlackAroundARoomSaysNoMoreThanUnknown) {
  const OccupancyGrid building = test::draw_building(3);
  const auto framed = [&](Cell around) {
    OccupancyGrid drawn =
        make_grid(building.width + 400, building.height + 300, building.resolution, {}, around);
    for (int row = 0; row < building.height; ++row)
      for (int column = 0; column < building.width; ++column)
        if (building.at(column, row) != Cell::unknown)
          drawn.at(column + 200, row + 150) = building.at(column, row);
    return drawn;
  };
  const OccupancyGrid painted = framed(Cell::occupied);
  const MatchResult itself = match(painted, painted);
  EXPECT_EQ(itself.verdict, Verdict::accepted);
  EXPECT_EQ(itself.T_fixed_moving, SE2{});
  const MatchResult other = match(painted, framed(Cell::unknown));
  EXPECT_EQ(other.verdict, Verdict::accepted);
  EXPECT_NEAR(std::hypot(other.T_fixed_moving.x, other.T_fixed_moving.y), 0.0, 0.1);
}

TEST(Painted, ABlackMapOfRoomsInRowsLiesOnItselfOrSaysThatItRepeats) {
  // Rooms that repeat along rows and columns, and all else black: the half turn fits nearly as well.
  OccupancyGrid map = make_grid(1000, 400, 0.05, {}, Cell::occupied);
  for (int row = 100; row < 280; ++row)
    for (int column = 150; column < 850; ++column)
      if ((column / 60 + row / 45) % 3 != 0) map.at(column, row) = Cell::free;
  const MatchResult itself = match(map, map);
  EXPECT_EQ(itself.T_fixed_moving, SE2{});
  EXPECT_EQ(itself.disagreement, 0);
  if (itself.verdict == Verdict::refused) {
    EXPECT_EQ(itself.reason, Reason::ambiguous);
  }
}

TEST(Steady, AMapLiesOnItselfExactly) {
  for (const unsigned seed : {1U, 2U, 3U}) {
    OccupancyGrid map = test::draw_building(seed);
    for (const SE2& origin : {SE2{}, SE2{-31.7, 12.3, 0.0}, SE2{1e6, -1e6, 2.1}}) {
      map.origin = origin;
      const MatchResult result = match(map, map);
      EXPECT_EQ(result.verdict, Verdict::accepted) << seed;
      EXPECT_EQ(result.T_fixed_moving, SE2{}) << seed;
      EXPECT_EQ(result.disagreement, 0) << seed;
    }
  }
}

TEST(Steady, AQuarterTurnOfAnInputChangesNothingElse) {
  const OccupancyGrid building = test::draw_building(2);
  const OccupancyGrid left = test::map_part(building, {0, 0, 12, 13}, {3.0, 1.0, 0.4});
  const OccupancyGrid right = test::map_part(building, {5, 0, 18, 13}, {-2.0, 5.0, -1.1});
  const MatchResult usual = match(left, right);
  ASSERT_EQ(usual.verdict, Verdict::accepted);
  for (const int quarters : {1, 2, 3}) {
    const MatchResult turned = match(left, internal::quarter_turned(right, quarters));
    EXPECT_NEAR(turned.probability, usual.probability, 1e-9) << quarters;
    EXPECT_NEAR(turned.T_fixed_moving.x, usual.T_fixed_moving.x, 1e-6) << quarters;
    EXPECT_NEAR(turned.T_fixed_moving.y, usual.T_fixed_moving.y, 1e-6) << quarters;
  }
}

/// A room of 6 x 5 m with things in it, seen with noise.
OccupancyGrid small_noisy_map(unsigned seed) {
  std::mt19937 random(seed);
  OccupancyGrid map = make_grid(120, 100, 0.05, {-2.0, -1.0, 0.3}, Cell::free);
  for (int x = 0; x < map.width; ++x) map.at(x, 0) = map.at(x, map.height - 1) = Cell::occupied;
  for (int y = 0; y < map.height; ++y) map.at(0, y) = map.at(map.width - 1, y) = Cell::occupied;
  for (int i = 0; i < 60; ++i) {
    const int x = 2 + static_cast<int>(random() % 110), y = 2 + static_cast<int>(random() % 90);
    for (int k = 0; k < 6; ++k) (i % 2 == 0 ? map.at(x + k, y) : map.at(x, y + k)) = Cell::occupied;
  }
  return map;
}

// Of maps that hold the same neither is the smaller one.
TEST(Steady, OfTheSameMapInTwoFramesItDoesNotMatterWhichIsCalledFixed) {
  for (unsigned seed = 1; seed <= 30; ++seed) {
    const OccupancyGrid map = small_noisy_map(seed);
    OccupancyGrid other = map;
    other.origin = SE2{1.7 * seed, -3.1, 0.21 * seed} * map.origin;
    const MatchResult forth = match(map, other), back = inverse(match(other, map));
    ASSERT_EQ(forth.hypotheses.size(), back.hypotheses.size()) << seed;
    EXPECT_EQ(forth.verdict, back.verdict) << seed;
    EXPECT_NEAR(forth.probability, back.probability, 1e-9) << seed;
  }
}

TEST(Steady, CuttingTheRimOffMovesNothing) {
  const OccupancyGrid building = test::draw_building(2);
  const OccupancyGrid left = test::map_part(building, {0, 0, 12, 13}, {3.0, 1.0, 0.4});
  const OccupancyGrid right = crop_to_known(test::map_part(building, {5, 0, 18, 13}, {-2.0, 5.0, -1.1}));
  const MatchResult usual = match(left, right);
  ASSERT_EQ(usual.verdict, Verdict::accepted);
  for (const int cut : {1, 2, 3}) {
    OccupancyGrid smaller = right;
    for (int row = 0; row < smaller.height; ++row) {
      for (int column = 0; column < smaller.width; ++column) {
        const int rim =
            std::min(std::min(column, row), std::min(smaller.width - 1 - column, smaller.height - 1 - row));
        if (rim < cut) smaller.at(column, row) = Cell::unknown;
      }
    }
    const MatchResult result = match(left, smaller);
    EXPECT_EQ(result.verdict, Verdict::accepted) << cut;
    EXPECT_NEAR(result.T_fixed_moving.x, usual.T_fixed_moving.x, 0.25) << cut;
    EXPECT_NEAR(result.T_fixed_moving.y, usual.T_fixed_moving.y, 0.25) << cut;
  }
}

TEST(Hopeless, NoiseBlackOneWallAndAnEmptyFloorAreRefused) {
  std::mt19937 random(1);
  OccupancyGrid noise = make_grid(300, 300, 0.05, {}, Cell::free);
  for (Cell& cell : noise.cells) {
    if (random() % 4 == 0) cell = Cell::occupied;
  }
  OccupancyGrid other_noise = noise;
  std::shuffle(other_noise.cells.begin(), other_noise.cells.end(), random);
  EXPECT_EQ(match(noise, other_noise).verdict, Verdict::refused);
  const MatchResult itself = match(noise, noise);
  EXPECT_TRUE(itself.verdict == Verdict::refused || itself.T_fixed_moving == SE2{});

  const OccupancyGrid black = make_grid(200, 100, 0.05, {}, Cell::occupied);
  EXPECT_EQ(match(black, black).reason, Reason::nothing_to_compare);
  const OccupancyGrid floor = make_grid(200, 100, 0.05, {}, Cell::free);
  EXPECT_EQ(match(floor, floor).reason, Reason::nothing_to_compare);
  OccupancyGrid wall = floor;
  for (int column = 0; column < 200; ++column) wall.at(column, 50) = Cell::occupied;
  const MatchResult one_wall = match(wall, wall);
  EXPECT_EQ(one_wall.verdict, Verdict::refused);
  EXPECT_EQ(one_wall.reason, Reason::ambiguous);
}

}  // namespace
}  // namespace gridmerge
