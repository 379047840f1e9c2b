// SPDX-License-Identifier: Apache-2.0
#include "simulate/tidy.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>
#include <vector>

namespace gridmerge {

using namespace internal;
namespace {

OccupancyGrid floor_with(const std::vector<std::pair<int, int>>& occupied) {
  OccupancyGrid map = make_grid(20, 10, 0.05, {1.0, 2.0, 0.5}, Cell::free);
  map.probability.assign(map.cells.size(), 0.2F);
  for (const auto& [column, row] : occupied) {
    map.at(column, row) = Cell::occupied;
    map.probability[static_cast<std::size_t>(row) * 20 + static_cast<std::size_t>(column)] = 0.8F;
  }
  return map;
}

TEST(Tidied, DropsSpecksAndKeepsWhatHangsTogether) {
  // Four cells in a row, and five that touch at corners.
  const OccupancyGrid map =
      tidied(floor_with({{1, 1}, {2, 1}, {3, 1}, {4, 1}, {10, 4}, {11, 5}, {12, 6}, {13, 7}, {14, 8}}), 0.0);
  EXPECT_EQ(count_cells(map).occupied, 5u);
  EXPECT_EQ(map.at(1, 1), Cell::free);
  EXPECT_LT(map.probability[20 + 1], 0.5F);
  EXPECT_EQ(map.at(12, 6), Cell::occupied);
}

TEST(Tidied, ThickensWallsOverTheRim) {
  const OccupancyGrid map = tidied(floor_with({{0, 0}, {1, 0}, {2, 0}, {3, 0}, {4, 0}}), 0.1);
  EXPECT_EQ(map.width, 22);   // two cells beyond the left
  EXPECT_EQ(map.height, 12);  // and the lower side
  EXPECT_EQ(map.at(2, 0), Cell::occupied);
  EXPECT_EQ(map.at(2, 4), Cell::occupied);
  EXPECT_EQ(map.at(2, 5), Cell::free);
  EXPECT_EQ(map.at(0, 0), Cell::unknown);
  // Where it was, though the lower left corner is another.
  const Point2 before = SE2{1.0, 2.0, 0.5} * Point2{0.1, 0.025};
  const Point2 after = map.origin * Point2{0.2, 0.125};
  EXPECT_NEAR(before.x, after.x, 1e-12);
  EXPECT_NEAR(before.y, after.y, 1e-12);
}

TEST(Tidied, ProbabilitiesGoWithTheCells) {
  const OccupancyGrid map = tidied(floor_with({{1, 1}, {10, 4}, {11, 4}, {12, 4}, {13, 4}, {14, 4}}), 0.05);
  ASSERT_EQ(map.width, 20);
  ASSERT_EQ(map.height, 10);
  const auto probability = [&](int column, int row) {
    return map.probability[static_cast<std::size_t>(row) * 20 + static_cast<std::size_t>(column)];
  };
  EXPECT_EQ(probability(1, 1), 0.1F);   // a speck that is free now
  EXPECT_EQ(probability(12, 4), 0.9F);  // a wall
  EXPECT_EQ(probability(12, 5), 0.9F);  // what it is thicker by
  EXPECT_EQ(probability(12, 3), 0.9F);
  EXPECT_EQ(probability(9, 4), 0.9F);
  EXPECT_EQ(probability(9, 5), 0.2F);  // beyond a corner
  EXPECT_EQ(probability(12, 6), 0.2F);
  for (int row = 0; row < 10; ++row) {
    for (int column = 0; column < 20; ++column)
      EXPECT_EQ(map.at(column, row) == Cell::occupied, probability(column, row) > 0.5F);
  }
}

TEST(Tidied, BeyondTheRimNothingIsKnown) {
  const OccupancyGrid map = tidied(floor_with({{0, 0}, {1, 0}, {2, 0}, {3, 0}, {4, 0}}), 0.1);
  std::size_t unknown = 0;
  for (std::size_t i = 0; i < map.cells.size(); ++i) {
    EXPECT_EQ(map.cells[i] == Cell::unknown, std::isnan(map.probability[i]));
    unknown += map.cells[i] == Cell::unknown ? 1 : 0;
  }
  // Two columns and two rows beside the 200 cells, less what the wall has grown by.
  EXPECT_EQ(unknown, 22u * 12u - 200u - 15u);
}

TEST(Tidied, AMapWithoutProbabilitiesHasNone) {
  OccupancyGrid map = floor_with({{0, 0}, {1, 0}, {2, 0}, {3, 0}, {4, 0}, {9, 9}});
  map.probability.clear();
  const OccupancyGrid thick = tidied(map, 0.1);
  EXPECT_TRUE(thick.probability.empty());
  EXPECT_EQ(thick.at(11, 11), Cell::free);
}

}  // namespace
}  // namespace gridmerge
