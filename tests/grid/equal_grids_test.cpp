// SPDX-License-Identifier: Apache-2.0
#include "grid/equal_grids.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>

namespace gridmerge::internal {
namespace {

OccupancyGrid some_map() {
  OccupancyGrid map = make_grid(3, 2, 0.05, {1.0, 2.0, 0.5}, Cell::free);
  map.at(1, 1) = Cell::occupied;
  return map;
}

TEST(EqualGrids, DifferInCellsSizeAndResolution) {
  const OccupancyGrid map = some_map();
  EXPECT_TRUE(has_equal_cells(map, some_map()));
  EXPECT_TRUE(are_equal(map, some_map()));
  const auto differs = [&](auto change) {
    OccupancyGrid other = map;
    change(other);
    EXPECT_FALSE(has_equal_cells(map, other));
    EXPECT_FALSE(are_equal(map, other));
    EXPECT_FALSE(are_equal(other, map));
  };
  differs([](OccupancyGrid& other) { other.at(0, 0) = Cell::unknown; });
  differs([](OccupancyGrid& other) { other.resolution = 0.1; });
  differs([](OccupancyGrid& other) { std::swap(other.width, other.height); });
  differs([](OccupancyGrid& other) { other = make_grid(3, 3, 0.05, other.origin, Cell::free); });
}

TEST(EqualGrids, HaveOneFrameToBeTheSame) {
  OccupancyGrid other = some_map();
  other.origin.theta = 0.25;
  EXPECT_TRUE(has_equal_cells(some_map(), other));
  EXPECT_FALSE(are_equal(some_map(), other));
}

TEST(EqualGrids, ProbabilitiesCountAndUnknownOnesAreEqual) {
  OccupancyGrid map = make_grid(2, 1, 0.05, {}, Cell::free);
  map.probability = {0.1f, std::nanf("")};
  OccupancyGrid other = map;
  EXPECT_TRUE(are_equal(map, other));
  other.probability[0] = 0.2f;
  EXPECT_FALSE(are_equal(map, other));
  EXPECT_TRUE(has_equal_cells(map, other));
  other.probability.clear();
  EXPECT_FALSE(are_equal(map, other));
}

}  // namespace
}  // namespace gridmerge::internal
