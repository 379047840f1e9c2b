// SPDX-License-Identifier: Apache-2.0
#include "online/robot_map.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "explorers.hpp"
#include "grid/equal_grids.hpp"
#include "gridmerge/grid/resample.hpp"

namespace gridmerge::internal {
namespace {

TEST(RobotMap, AMapThatGrowsGoesOn) {
  const test::Explorers explorers;
  for (int step = 1; step < test::Explorers::kSteps; ++step) {
    const MapChange change = change_between(explorers.map(0, step), explorers.map(0, step + 1));
    EXPECT_FALSE(change.other_frame);
    EXPECT_GT(change.share, 0.05);
    EXPECT_LT(change.share, 0.5);
  }
}

TEST(RobotMap, TheSameMapHasNotChanged) {
  const OccupancyGrid map = test::Explorers().map(1, 3);
  EXPECT_EQ(change_between(map, map).share, 0.0);
  // On a larger sheet it is the same to robots, though not the same message.
  OccupancyGrid sheet = make_grid(map.width + 10, map.height, map.resolution, map.origin);
  for (int row = 0; row < map.height; ++row) {
    for (int column = 0; column < map.width; ++column) sheet.at(column, row) = map.at(column, row);
  }
  EXPECT_EQ(change_between(map, sheet).share, 0.0);
  EXPECT_TRUE(are_equal(map, map));
  EXPECT_FALSE(are_equal(map, sheet));
}

TEST(RobotMap, AMapThatIsBentKeepsItsWalls) {
  const OccupancyGrid map = test::Explorers().map(0, 5);
  OccupancyGrid bent = map;  // its right half lies elsewhere
  for (int row = 0; row < map.height; ++row) {
    for (int column = map.width / 2; column < map.width; ++column)
      bent.at(column, row) = row < 12 ? Cell::unknown : map.at(column, row - 12);
  }
  EXPECT_TRUE(change_between(map, bent).other_frame);
  EXPECT_TRUE(keeps_walls(map, bent));
  EXPECT_TRUE(keeps_walls(make_grid(9, 9, 0.05), map)) << "there were none";
  EXPECT_FALSE(keeps_walls(map, make_grid(9, 9, 0.05)));
  const OccupancyGrid strip = make_grid(1 << 20, 1, 0.05, {}, Cell::occupied);
  EXPECT_FALSE(keeps_walls(map, strip)) << "too long for distances";
}

TEST(RobotMap, AnotherFrameIsSeen) {
  const test::Explorers explorers;
  const OccupancyGrid map = explorers.map(0, 5);
  for (const SE2& T : {SE2{1.0, 0.0, 0.0}, SE2{0.0, 0.0, 0.3}, SE2{4.0, 2.0, 2.0}, SE2{100.0, 0.0, 0.0}})
    EXPECT_TRUE(change_between(map, transform_grid(map, T, map.resolution)).other_frame)
        << T.x << " " << T.theta;
  for (const SE2& T : {SE2{1.0, 0.0, 0.0}, SE2{0.0, 0.0, 0.3}, SE2{4.0, 2.0, 2.0}, SE2{100.0, 0.0, 0.0}})
    EXPECT_FALSE(keeps_walls(map, transform_grid(map, T, map.resolution))) << T.x << " " << T.theta;
  EXPECT_TRUE(change_between(map, explorers.map(3, 5)).other_frame);
  EXPECT_TRUE(change_between(map, explorers.map(0, 1)).other_frame);  // it has lost most of what it knew
}

RC_GTEST_PROP(RobotMap, ChangesAreThoseOfACountCellByCell, ()) {
  const auto drawn = [](int width, int height, const SE2& origin) {
    OccupancyGrid map = make_grid(width, height, 1.0, origin);
    for (Cell& cell : map.cells)
      cell = *rc::gen::element(Cell::unknown, Cell::free, Cell::free, Cell::occupied);
    return map;
  };
  const OccupancyGrid before = drawn(*rc::gen::inRange(1, 4), *rc::gen::inRange(1, 4), {});
  OccupancyGrid after = drawn(*rc::gen::inRange(1, 4), *rc::gen::inRange(1, 4), {});
  if (*rc::gen::inRange(0, 2) == 0) {  // it goes on from the one before
    for (int row = 0; row < std::min(before.height, after.height); ++row) {
      for (int column = 0; column < std::min(before.width, after.width); ++column)
        after.at(column, row) = before.at(column, row);
    }
  }
  double both = 0.0, equal = 0.0;
  for (int row = 0; row < std::min(before.height, after.height); ++row) {
    for (int column = 0; column < std::min(before.width, after.width); ++column) {
      const Cell a = before.at(column, row), b = after.at(column, row);
      both += a != Cell::unknown && b != Cell::unknown ? 1.0 : 0.0;
      equal += a != Cell::unknown && a == b ? 1.0 : 0.0;
    }
  }
  const double known_before = static_cast<double>(count_cells(before).known());
  const double known_after = static_cast<double>(count_cells(after).known());
  const MapChange change = change_between(before, after);
  const double most = std::max(known_before, known_after);
  RC_ASSERT(std::abs(change.share - (most == 0.0 ? 0.0 : 1.0 - equal / most)) < 1e-12);
  // It has kept half of what it knew, and nine tenths of what both know is the same.
  const bool goes_on =
      known_after == 0.0 ? known_before == 0.0 : both >= 0.5 * known_before && equal >= 0.9 * both;
  RC_ASSERT(change.other_frame == !goes_on);
}

/// The limits themselves are allowed.
TEST(RobotMap, GoesOnWhereHalfIsKnownStillAndNineTenthsOfThatAreTheSame) {
  const OccupancyGrid before = make_grid(20, 1, 1.0, {}, Cell::free);
  const auto is_other_frame = [&](std::ptrdiff_t kept, std::ptrdiff_t changed) {
    OccupancyGrid after = make_grid(20, 1, 1.0);
    std::fill_n(after.cells.begin(), kept, Cell::free);
    std::fill_n(after.cells.begin(), changed, Cell::occupied);
    return change_between(before, after).other_frame;
  };
  EXPECT_FALSE(is_other_frame(10, 0));
  EXPECT_TRUE(is_other_frame(9, 0));
  EXPECT_FALSE(is_other_frame(10, 1));
  EXPECT_TRUE(is_other_frame(10, 2));
  EXPECT_FALSE(is_other_frame(20, 2));
  EXPECT_TRUE(is_other_frame(20, 3));
}

TEST(RobotMap, BlankMapsBeginAnything) {
  const OccupancyGrid blank = make_grid(5, 5, 0.05), map = test::Explorers().map(0, 1);
  EXPECT_FALSE(change_between(blank, map).other_frame);
  EXPECT_EQ(change_between(blank, map).share, 1.0);
  EXPECT_TRUE(change_between(map, blank).other_frame);
  EXPECT_EQ(change_between(blank, blank).share, 0.0);
}

}  // namespace
}  // namespace gridmerge::internal
