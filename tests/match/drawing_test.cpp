// SPDX-License-Identifier: Apache-2.0
#include "match/drawing.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <utility>

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

TEST(Drawing, HasPaperAlongItsWholeRim) {
  const OccupancyGrid sheet = outline(Cell::free, 0);
  for (const Cell ink : {Cell::occupied, Cell::unknown}) {
    for (const auto& [column, row] :
         {std::pair(0, 0), {99, 0}, {0, 79}, {99, 79}, {50, 0}, {50, 79}, {0, 40}, {99, 40}}) {
      OccupancyGrid map = sheet;
      map.at(column, row) = ink;
      EXPECT_FALSE(is_drawing(map)) << column << ' ' << row;
    }
    for (const auto& [column, row] : {std::pair(1, 1), {98, 78}, {50, 1}, {50, 78}, {1, 40}, {98, 40}}) {
      OccupancyGrid map = sheet;
      map.at(column, row) = ink;
      EXPECT_TRUE(is_drawing(map)) << column << ' ' << row;
    }
  }
}

TEST(Drawing, HasNoWideGray) {
  // What lies more than three cells from white may be a hundredth of it: 80 of 8,000 cells.
  for (const int side : {14, 15}) {
    OccupancyGrid map = outline(Cell::free, 0);
    for (int row = 0; row < side; ++row)
      for (int column = 0; column < 16; ++column) map.at(30 + column, 30 + row) = Cell::unknown;
    EXPECT_EQ(is_drawing(map), side == 14) << side;  // 10 x 8 cells, or 10 x 9
  }
}

// As of any picture that was scaled, or drawn with smooth lines.
TEST(Drawing, MayHaveGrayLinesAndSoftEdges) {
  OccupancyGrid sheet = outline(Cell::free, 0);
  for (int column = 21; column < 80; ++column)
    sheet.at(column, 19) = sheet.at(column, 21) = sheet.at(column, 22) = Cell::unknown;
  for (int row = 25; row <= 55; ++row) sheet.at(50, row) = Cell::unknown;  // a gray line of its own
  ASSERT_TRUE(is_drawing(sheet));
  const OccupancyGrid map = with_enclosed_free(sheet);
  EXPECT_EQ(count_cells(map).occupied, count_cells(outline(Cell::free, 0)).occupied + 31U);
  EXPECT_EQ(at(map, 5.05, 4.05), Cell::occupied);
  EXPECT_EQ(at(map, 3.05, 2.15), Cell::free);
  EXPECT_EQ(at(map, 3.05, 1.85), Cell::unknown);
}

TEST(Drawing, MayHaveGrayLinesAlone) {
  OccupancyGrid sheet = outline(Cell::free, 0);
  std::replace(sheet.cells.begin(), sheet.cells.end(), Cell::occupied, Cell::unknown);
  EXPECT_TRUE(is_drawing(sheet));
  const OccupancyGrid enclosed = with_enclosed_free(sheet);
  EXPECT_EQ(count_cells(enclosed).occupied, count_cells(outline(Cell::free, 0)).occupied);
  EXPECT_EQ(at(enclosed, 5.0, 4.0), Cell::free);
  EXPECT_EQ(at(enclosed, 1.0, 4.0), Cell::unknown);
  for (int row = 20; row <= 60; ++row) {
    for (int column = 60; column <= 80; ++column) sheet.at(column, row) = Cell::unknown;
  }
  EXPECT_TRUE(is_drawing(sheet)) << "a thick wall";
  EXPECT_EQ(at(with_enclosed_free(sheet), 7.0, 4.0), Cell::occupied);
  // Floor of which a few cells were not seen.
  OccupancyGrid floor = make_grid(100, 80, 0.1, {}, Cell::free);
  floor.at(50, 40) = floor.at(51, 40) = floor.at(20, 30) = Cell::unknown;
  EXPECT_FALSE(is_drawing(floor));
  EXPECT_FALSE(is_drawing(make_grid(10, 10, 0.1, {}, Cell::free)));
}

TEST(Drawing, ClosesGapsUpToAShareOfItsLongerSide) {
  // The outline is 61 cells long: 8 % of that are four cells. Whichever wall has the gap.
  for (const bool is_turned : {false, true}) {
    for (int gap = 0; gap <= 7; ++gap) {
      OccupancyGrid sheet = outline(Cell::unknown, gap);
      if (is_turned) {
        OccupancyGrid turned = make_grid(sheet.height, sheet.width, sheet.resolution);
        for (int row = 0; row < sheet.height; ++row) {
          for (int column = 0; column < sheet.width; ++column) turned.at(row, column) = sheet.at(column, row);
        }
        sheet = turned;
      }
      const CellCounts counts = count_cells(with_enclosed_free(sheet));
      // All of the inside, 59 x 39 cells, or none of it; and of a gap that is closed at most its own cells.
      EXPECT_GE(counts.free, gap <= 4 ? 59U * 39U : 0U) << gap;
      EXPECT_LE(counts.free, gap <= 4 ? 59U * 39U + static_cast<unsigned>(gap) : 59U * 39U / 2U) << gap;
    }
  }
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

TEST(Drawing, OfALongStripNoWideGapIsClosed) {
  // A closing of half a hundredth of its length has a margin of 5000 cells: 10^10 cells for the widest.
  OccupancyGrid strip = make_grid(1000000, 1, 0.05);
  strip.at(0, 0) = strip.at(999999, 0) = Cell::occupied;
  const OccupancyGrid enclosed = with_enclosed_free(strip);
  EXPECT_EQ(enclosed.width, 1000000);
  EXPECT_EQ(count_cells(enclosed).occupied, 2u);
  EXPECT_EQ(count_cells(enclosed).free, 0u);
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
