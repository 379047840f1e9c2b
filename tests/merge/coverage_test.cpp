// SPDX-License-Identifier: Apache-2.0
#include "merge/coverage.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace gridmerge::internal {
namespace {

/// Some known cells here and there in a larger grid, whose frame is anywhere.
OccupancyGrid some_cells(std::mt19937& random) {
  const int width = 20 + static_cast<int>(random() % 300), height = 20 + static_cast<int>(random() % 200);
  OccupancyGrid grid = make_grid(width, height, 0.05 + 0.01 * static_cast<double>(random() % 10));
  grid.origin = {static_cast<double>(random() % 40) - 20.0, static_cast<double>(random() % 40) - 20.0,
                 0.01 * static_cast<double>(random() % 600)};
  for (int i = 1 + static_cast<int>(random() % 60); i > 0; --i) {
    grid.at(static_cast<int>(random() % static_cast<unsigned>(width)),
            static_cast<int>(random() % static_cast<unsigned>(height))) =
        random() % 2 == 0 ? Cell::free : Cell::occupied;
  }
  return grid;
}

/// The middles of the known cells, and how far apart their outermost edges are.
MapExtent extent_by_definition(const OccupancyGrid& grid) {
  std::vector<Point2> points;
  int left = grid.width, right = 0, bottom = grid.height, top = 0;
  for (int row = 0; row < grid.height; ++row) {
    for (int column = 0; column < grid.width; ++column) {
      if (grid.at(column, row) == Cell::unknown) continue;
      points.push_back(grid.origin * Point2{(column + 0.5) * grid.resolution, (row + 0.5) * grid.resolution});
      left = std::min(left, column);
      right = std::max(right, column + 1);
      bottom = std::min(bottom, row);
      top = std::max(top, row + 1);
    }
  }
  MapExtent extent;
  const double count = static_cast<double>(points.size());
  for (const Point2& p : points) {
    extent.centre.x += p.x / count;
    extent.centre.y += p.y / count;
  }
  double squares = 0.0;
  for (const Point2& p : points)
    squares += std::pow(p.x - extent.centre.x, 2) + std::pow(p.y - extent.centre.y, 2);
  extent.radius = std::sqrt(squares / count);
  extent.side = grid.resolution * std::max(right - left, top - bottom);
  return extent;
}

TEST(Coverage, ItsExtentIsThatOfTheKnownCells) {
  std::mt19937 random(7);
  for (int run = 0; run < 40; ++run) {
    const OccupancyGrid grid = some_cells(random);
    const MapExtent expected = extent_by_definition(grid), found = Coverage(grid).extent();
    EXPECT_NEAR(found.centre.x, expected.centre.x, 1e-9) << run;
    EXPECT_NEAR(found.centre.y, expected.centre.y, 1e-9) << run;
    EXPECT_NEAR(found.radius, expected.radius, 1e-6) << run;
    EXPECT_NEAR(found.side, expected.side, 1e-9) << run;
  }
}

TEST(Coverage, AMapThatKnowsNothingHasNoExtentAndSharesNothing) {
  OccupancyGrid one = make_grid(30, 20, 0.1);
  const Coverage nothing(one);
  one.at(29, 19) = Cell::free;
  const Coverage corner(one);
  EXPECT_EQ(nothing.extent().radius, 0.0);
  EXPECT_EQ(nothing.extent().side, 0.0);
  EXPECT_NEAR(corner.extent().radius, 0.0, 1e-6);
  EXPECT_NEAR(corner.extent().side, 0.1, 1e-12);
  const ManyPointsTransform same{SE2{}};
  EXPECT_EQ(nothing.share_in_common(nothing, same), 0.0);
  EXPECT_EQ(nothing.share_in_common(corner, same), 0.0);
  EXPECT_EQ(corner.share_in_common(nothing, same), 0.0);
  EXPECT_EQ(corner.share_in_common(corner, same), 1.0);
}

/// `columns` known ones of cells of 1 m, from the left.
OccupancyGrid strip(int columns) {
  OccupancyGrid grid = make_grid(40, 10, 1.0);
  for (int row = 0; row < 10; ++row)
    for (int column = 0; column < columns; ++column) grid.at(column, row) = Cell::free;
  return grid;
}

TEST(Coverage, CountsTheSmallerMapsPlacesThatBothKnow) {
  const Coverage large(strip(40)), small(strip(15));  // 400 and 150 places, of which at most 200 are drawn
  for (int shift = -20; shift <= 45; ++shift) {
    const SE2 T{static_cast<double>(shift), 0.0, 0.0};
    const int common = std::max(0, std::min(40, shift + 15) - std::max(0, shift));
    EXPECT_NEAR(large.share_in_common(small, ManyPointsTransform(T)), common / 15.0, 1e-12) << shift;
    EXPECT_NEAR(small.share_in_common(large, ManyPointsTransform(inverse(T))), common / 15.0, 1e-12) << shift;
  }
}

TEST(Coverage, PlacesInCommonAreKnownToBothWhicheverIsTheSmaller) {
  const Coverage large(strip(40)), small(strip(15));
  const SE2 T_large_small{30.0, 0.0, 0.0}, T_frame_large{100.0, -50.0, 0.0};
  const SE2 T_frame_small = T_frame_large * T_large_small;
  for (const std::vector<Point2>& places :
       {large.places_in_common(small, ManyPointsTransform(T_large_small), ManyPointsTransform(T_frame_large)),
        small.places_in_common(large, ManyPointsTransform(inverse(T_large_small)),
                               ManyPointsTransform(T_frame_small))}) {
    ASSERT_EQ(places.size(), 100U);  // ten of the fifteen columns
    for (const Point2& place : places) {
      EXPECT_TRUE(place.x > 130.0 && place.x < 140.0) << place.x;
      EXPECT_TRUE(place.y > -50.0 && place.y < -40.0) << place.y;
    }
  }
}

TEST(Coverage, AtMostTwoHundredPlacesAreDrawnEvenly) {
  const Coverage map(strip(40));
  const ManyPointsTransform same{SE2{}};
  const std::vector<Point2> places = map.places_in_common(map, same, same);
  ASSERT_EQ(places.size(), 200U);
  int left = 0, below = 0;
  for (const Point2& place : places) {
    left += place.x < 20.0 ? 1 : 0;
    below += place.y < 5.0 ? 1 : 0;
  }
  EXPECT_EQ(left, 100);
  EXPECT_EQ(below, 100);
}

}  // namespace
}  // namespace gridmerge::internal
