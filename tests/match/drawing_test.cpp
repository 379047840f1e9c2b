// SPDX-License-Identifier: Apache-2.0
#include "match/drawing.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "support/building.hpp"

namespace gridmerge {

using namespace internal;
namespace {

/// A sheet with the outline of a room from (20, 20) to (80, 60), with a gap of `gap` cells in its lower wall.
OccupancyGrid outline(Cell paper, int gap) {
  OccupancyGrid sheet = make_grid(100, 80, 0.1);
  for (Cell& cell : sheet.cells) cell = paper;
  for (int column = 20; column <= 80; ++column) {
    sheet.at(column, 60) = Cell::occupied;
    if (column < 50 || column >= 50 + gap) sheet.at(column, 20) = Cell::occupied;
  }
  for (int row = 20; row <= 60; ++row) sheet.at(20, row) = sheet.at(80, row) = Cell::occupied;
  return sheet;
}

Cell at(const OccupancyGrid& map, double x, double y) {
  const int column = static_cast<int>((x - map.origin.x) / map.resolution);
  const int row = static_cast<int>((y - map.origin.y) / map.resolution);
  const bool inside = column >= 0 && row >= 0 && column < map.width && row < map.height;
  return inside ? map.at(column, row) : Cell::unknown;
}

TEST(Drawing, IsTold) {
  EXPECT_TRUE(is_drawing(outline(Cell::unknown, 0)));
  EXPECT_TRUE(is_drawing(outline(Cell::free, 0)));
  EXPECT_FALSE(is_drawing(test::draw_building(1)));  // walls along its rim
  EXPECT_FALSE(is_drawing(make_grid(10, 10, 0.1)));  // nothing is drawn
  OccupancyGrid map = outline(Cell::unknown, 0);
  map.at(50, 40) = Cell::free;
  EXPECT_FALSE(is_drawing(map));
}

TEST(Drawing, WhatItEnclosesIsFree) {
  for (const Cell paper : {Cell::unknown, Cell::free}) {
    const OccupancyGrid map = with_enclosed_free(outline(paper, 0));
    EXPECT_EQ(at(map, 5.05, 4.05), Cell::free);
    EXPECT_EQ(at(map, 2.15, 2.15), Cell::free);
    EXPECT_EQ(at(map, 2.05, 4.05), Cell::occupied);
    EXPECT_EQ(at(map, 1.05, 4.05), Cell::unknown);
    EXPECT_EQ(count_cells(map).occupied, count_cells(outline(paper, 0)).occupied);
  }
}

TEST(Drawing, ADoorOfTheOutlineIsClosedAndAMissingWallIsNot) {
  const OccupancyGrid door = with_enclosed_free(outline(Cell::unknown, 4));
  EXPECT_EQ(at(door, 5.05, 4.05), Cell::free);
  EXPECT_EQ(at(door, 5.25, 1.05), Cell::unknown);
  const OccupancyGrid open = with_enclosed_free(outline(Cell::unknown, 25));
  EXPECT_EQ(at(open, 6.05, 4.05), Cell::unknown);
  EXPECT_EQ(at(open, 2.05, 4.05), Cell::occupied);
}

TEST(Drawing, AMapStaysAsItIs) {
  const OccupancyGrid map = test::draw_building(1);
  EXPECT_EQ(with_enclosed_free(map).cells, map.cells);
}

RC_GTEST_PROP(Drawing, WallsStayWhereTheyAreWhateverIsDrawn, ()) {
  OccupancyGrid sheet = make_grid(*rc::gen::inRange(1, 40), *rc::gen::inRange(1, 40), 0.1);
  for (Cell& cell : sheet.cells) cell = *rc::gen::inRange(0, 5) == 0 ? Cell::occupied : Cell::unknown;
  const OccupancyGrid map = with_enclosed_free(sheet);
  RC_ASSERT(count_cells(map).occupied == count_cells(sheet).occupied);
  for (int row = 0; row < sheet.height; ++row) {
    for (int column = 0; column < sheet.width; ++column) {
      if (sheet.at(column, row) == Cell::occupied)
        RC_ASSERT(at(map, (column + 0.5) * 0.1, (row + 0.5) * 0.1) == Cell::occupied);
    }
  }
}

}  // namespace
}  // namespace gridmerge
