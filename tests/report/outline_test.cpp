// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "report/interchange.hpp"
#include "report/interchange_support.hpp"

namespace gridmerge {

using namespace internal;
using namespace test;
namespace {

RC_GTEST_PROP(Outlines, HoldEveryKnownCellAndTouchTheirCorners, ()) {
  const OccupancyGrid map = any_map();
  const std::vector<Point2> outline = known_outline(map);
  RC_ASSERT(outline.size() >= 4u);
  RC_ASSERT(twice_area(outline) > 0.0);
  std::vector<Point2> corners;
  for (int row = 0; row < map.height; ++row) {
    for (int column = 0; column < map.width; ++column) {
      if (map.cells[static_cast<std::size_t>(row * map.width + column)] == Cell::unknown) continue;
      for (const double dx : {0.0, 1.0}) {
        for (const double dy : {0.0, 1.0})
          corners.push_back(map.origin * Point2{(column + dx) * map.resolution, (row + dy) * map.resolution});
      }
    }
  }
  for (const Point2& corner : corners) RC_ASSERT(outside(outline, corner) < 1e-9);
  for (const Point2& point : outline) {
    RC_ASSERT(std::any_of(corners.begin(), corners.end(), [&](const Point2& corner) {
      return std::hypot(corner.x - point.x, corner.y - point.y) < 1e-9;
    }));
  }
}

RC_GTEST_PROP(Outlines, AreThoseOfEveryTriple, ()) {
  // A point is a corner if it lies in no triangle of others: brute force.
  std::vector<Point2> points(*rc::gen::inRange<std::size_t>(3, 9));
  for (Point2& point : points) point = {real_between(-5, 5), real_between(-5, 5)};
  const std::vector<Point2> hull = convex_hull(points);
  RC_PRE(hull.size() >= 3u);
  for (const Point2& point : points) {
    bool is_inside = false;
    for (const Point2& a : points)
      for (const Point2& b : points)
        for (const Point2& c : points) {
          if (a == point || b == point || c == point || twice_area({a, b, c}) <= 0.0) continue;
          is_inside = is_inside || outside({a, b, c}, point) < 0.0;
        }
    const bool is_corner = std::find(hull.begin(), hull.end(), point) != hull.end();
    RC_ASSERT(!(is_inside && is_corner));
    RC_ASSERT(outside(hull, point) < 1e-12);
  }
}

using Points = std::vector<Point2>;

TEST(ConvexHull, OfFewPointsOrALine) {
  EXPECT_EQ(convex_hull({}), Points{});
  EXPECT_EQ(convex_hull({{1.0, 2.0}, {1.0, 2.0}}), (Points{{1.0, 2.0}}));
  EXPECT_EQ(convex_hull({{3.0, 2.0}, {1.0, 2.0}}), (Points{{1.0, 2.0}, {3.0, 2.0}}));
  EXPECT_EQ(convex_hull({{0.0, 0.0}, {1.0, 1.0}, {2.0, 2.0}, {3.0, 3.0}}), (Points{{0.0, 0.0}, {3.0, 3.0}}));
}

TEST(ConvexHull, LacksWhatLiesOnAStraightLineBetweenOthers) {
  Points points;
  for (int i = 0; i < 25; ++i) points.push_back({static_cast<double>(i / 5), static_cast<double>(i % 5)});
  EXPECT_EQ(convex_hull(points), (Points{{0.0, 0.0}, {4.0, 0.0}, {4.0, 4.0}, {0.0, 4.0}}));
}

TEST(KnownCorners, AreThoseOfTheKnownCells) {
  OccupancyGrid map = make_grid(10, 8, 0.5, {1.0, 2.0, 0.0});
  EXPECT_EQ(known_corners(map), Points{});
  map.at(2, 6) = map.at(7, 1) = Cell::free;
  EXPECT_EQ(known_corners(map), (Points{{2.0, 2.5}, {5.0, 2.5}, {5.0, 5.5}, {2.0, 5.5}}));
}

TEST(SpreadCells, AreThoseNearestToTheMiddlesOfSixteenParts) {
  OccupancyGrid map = make_grid(30, 22, 1.0);
  for (int row = 4; row < 16; ++row) {
    for (int column = 3; column < 23; ++column) map.at(column, row) = Cell::free;
  }
  // 20 x 12 cells: each part has 5 x 3, with a cell in its middle.
  Points expected;
  for (const double y : {5.5, 8.5, 11.5, 14.5}) {
    for (const double x : {5.5, 10.5, 15.5, 20.5}) expected.push_back({x, y});
  }
  EXPECT_EQ(spread_cells(map), expected);
  // Of a part in which nothing is known there is none; beside a hole, the next one.
  for (int row = 4; row < 7; ++row) {
    for (int column = 8; column < 13; ++column) map.at(column, row) = Cell::unknown;
  }
  map.at(15, 8) = Cell::unknown;
  expected.erase(expected.begin() + 1);
  expected[5] = {15.5, 7.5};
  EXPECT_EQ(spread_cells(map), expected);
  EXPECT_EQ(spread_cells(make_grid(5, 5, 1.0)), Points{});
}

}  // namespace
}  // namespace gridmerge
