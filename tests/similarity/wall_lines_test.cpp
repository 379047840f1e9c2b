// SPDX-License-Identifier: Apache-2.0
#include "similarity/wall_lines.hpp"

#include <gtest/gtest.h>

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

}  // namespace
}  // namespace gridmerge
