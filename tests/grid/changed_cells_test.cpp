// SPDX-License-Identifier: Apache-2.0
#include "grid/changed_cells.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <limits>

#include "generators.hpp"
#include "grid/equal_grids.hpp"

namespace gridmerge::internal {
namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

RC_GTEST_PROP(ChangedCells, AreTheSmallestBoxThatHoldsThem, (const OccupancyGrid& before)) {
  OccupancyGrid after = before;
  CellBox expected;
  for (int i = *rc::gen::inRange(0, 4); i > 0; --i) {
    const int column = *rc::gen::inRange(0, before.width), row = *rc::gen::inRange(0, before.height);
    Cell& cell = after.at(column, row);
    if (cell != before.at(column, row)) continue;
    cell = cell == Cell::occupied ? Cell::free : Cell::occupied;
    expected = unite(expected, {column, row, column + 1, row + 1});
  }
  const auto changed = changed_cells(before, after);
  RC_ASSERT(changed.has_value());
  RC_ASSERT(changed->empty() == are_equal(before, after));
  RC_ASSERT(changed->left == expected.left && changed->right == expected.right);
  RC_ASSERT(changed->bottom == expected.bottom && changed->top == expected.top);
}

TEST(ChangedCells, HaveOtherProbabilitiesToo) {
  OccupancyGrid before = make_grid(4, 3, 0.1, {}, Cell::free);
  before.probability = std::vector<float>(12, 0.25f);
  before.probability[0] = kNaN;
  OccupancyGrid after = before;
  EXPECT_TRUE(changed_cells(before, after)->empty()) << "what is not known equals itself";
  after.probability[after.index(2, 1)] = 0.125f;
  const auto changed = changed_cells(before, after);
  EXPECT_EQ(changed->left, 2);
  EXPECT_EQ(changed->bottom, 1);
  EXPECT_EQ(changed->width(), 1);
  EXPECT_EQ(changed->height(), 1);
  after.probability.clear();
  EXPECT_EQ(changed_cells(before, after)->width(), 4) << "all cells have lost theirs";
  EXPECT_EQ(changed_cells(before, after)->height(), 3);
}

TEST(ChangedCells, AreOfMapsWithTheSameCells) {
  const OccupancyGrid map = make_grid(4, 3, 0.1, {1.0, 2.0, 0.5}, Cell::free);
  const auto differs = [&](auto change) {
    OccupancyGrid other = map;
    change(other);
    EXPECT_FALSE(changed_cells(map, other));
    EXPECT_FALSE(changed_cells(other, map));
  };
  differs([](OccupancyGrid& other) { other.resolution = 0.2; });
  differs([](OccupancyGrid& other) { other.origin.theta = 0.25; });
  differs([](OccupancyGrid& other) { other = make_grid(3, 4, 0.1, other.origin, Cell::free); });
  differs([](OccupancyGrid& other) { other = make_grid(4, 4, 0.1, other.origin, Cell::free); });
}

}  // namespace
}  // namespace gridmerge::internal
