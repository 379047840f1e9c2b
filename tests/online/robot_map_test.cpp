// SPDX-License-Identifier: Apache-2.0
#include "online/robot_map.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "explorers.hpp"
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

TEST(RobotMap, AnotherFrameIsSeen) {
  const test::Explorers explorers;
  const OccupancyGrid map = explorers.map(0, 5);
  for (const SE2& T : {SE2{1.0, 0.0, 0.0}, SE2{0.0, 0.0, 0.3}, SE2{4.0, 2.0, 2.0}, SE2{100.0, 0.0, 0.0}})
    EXPECT_TRUE(change_between(map, transform_grid(map, T, map.resolution)).other_frame)
        << T.x << " " << T.theta;
  EXPECT_TRUE(change_between(map, explorers.map(3, 5)).other_frame);
  EXPECT_TRUE(change_between(map, explorers.map(0, 1)).other_frame);  // it has lost most of what it knew
}

TEST(RobotMap, BlankMapsBeginAnything) {
  const OccupancyGrid blank = make_grid(5, 5, 0.05), map = test::Explorers().map(0, 1);
  EXPECT_FALSE(change_between(blank, map).other_frame);
  EXPECT_EQ(change_between(blank, map).share, 1.0);
  EXPECT_TRUE(change_between(map, blank).other_frame);
  EXPECT_EQ(change_between(blank, blank).share, 0.0);
}

TEST(RobotMap, ProbabilitiesCountAndUnknownOnesAreEqual) {
  OccupancyGrid map = make_grid(2, 1, 0.05, {}, Cell::free);
  map.probability = {0.1f, std::nanf("")};
  OccupancyGrid other = map;
  EXPECT_TRUE(are_equal(map, other));
  other.probability[0] = 0.2f;
  EXPECT_FALSE(are_equal(map, other));
  other.probability.clear();
  EXPECT_FALSE(are_equal(map, other));
}

}  // namespace
}  // namespace gridmerge::internal
