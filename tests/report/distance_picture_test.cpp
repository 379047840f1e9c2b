// SPDX-License-Identifier: Apache-2.0
#include "report/distance_picture.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <utility>

#include "gridmerge/grid/occupancy_grid.hpp"
#include "io/png.hpp"

namespace gridmerge {

using namespace internal;
namespace {

/// The gray of a pixel, which must be one.
int gray_at(const PngImage& image, int x, int y) {
  const std::size_t at = (static_cast<std::size_t>(y) * image.width + x) * image.channels;
  for (int channel = 1; channel < std::min(image.channels, 3); ++channel)
    EXPECT_EQ(image.samples[at], image.samples[at + channel]);
  return image.samples[at];
}

TEST(DistancePicture, GrowsLighterWithTheDistance) {
  OccupancyGrid map = make_grid(60, 50, 1.0);
  map.at(10, 0) = Cell::occupied;  // at the bottom
  const PngImage image = decode_png(distance_map_png(make_distance_map(map, Cell::occupied)));
  ASSERT_EQ(image.width, 60);
  ASSERT_EQ(image.height, 50);
  EXPECT_EQ(gray_at(image, 10, 49), 0);
  EXPECT_EQ(gray_at(image, 59, 0), 255);
  EXPECT_LT(gray_at(image, 10, 30), gray_at(image, 10, 20));
}

TEST(DistancePicture, OfASmallMapHoldsTheNumbers) {
  OccupancyGrid map = make_grid(3, 2, 1.0);
  map.at(0, 0) = Cell::occupied;
  const PngImage near = decode_png(distance_map_png(make_distance_map(map, Cell::occupied)));
  const PngImage start = decode_png(distance_map_png(trace_distance_map(map, Cell::occupied).start));
  EXPECT_EQ(near.width, 3 * 24 + 1);
  EXPECT_EQ(near.height, 2 * 24 + 1);
  // The cell of the value is black with a white 0; where there is no distance, black letters on white. Edges
  // of letters are gray.
  const auto count = [](const PngImage& image, int column, int shade) {
    int pixels = 0;
    for (int y = 25; y < 48; ++y) {
      for (int x = 24 * column + 1; x < 24 * (column + 1); ++x) {
        pixels += std::abs(gray_at(image, x, y) - shade) < 64;
      }
    }
    return pixels;
  };
  EXPECT_GT(count(near, 0, 255), 5);
  EXPECT_GT(count(near, 0, 0), 400);
  EXPECT_GT(count(start, 1, 0), 5);
  EXPECT_GT(count(start, 1, 255), 400);
}

TEST(DistancePicture, OfAMapWithoutTheValueIsWhite) {
  const DistanceMap none = make_distance_map(make_grid(50, 3, 1.0), Cell::free);
  const PngImage image = decode_png(distance_map_png(none));
  EXPECT_EQ(gray_at(image, 25, 1), 255);
}

TEST(DistancePicture, HoldsNumbersUpToFortyCellsASide) {
  const auto size_of = [](int width, int height) {
    OccupancyGrid map = make_grid(width, height, 1.0);
    map.at(0, 0) = Cell::occupied;
    const PngImage image = decode_png(distance_map_png(make_distance_map(map, Cell::occupied)));
    return std::pair(image.width, image.height);
  };
  EXPECT_EQ(size_of(40, 2), std::pair(40 * 24 + 1, 2 * 24 + 1));
  EXPECT_EQ(size_of(2, 40), std::pair(2 * 24 + 1, 40 * 24 + 1));
  EXPECT_EQ(size_of(41, 2), std::pair(41, 2));
  EXPECT_EQ(size_of(2, 41), std::pair(2, 41));
}

TEST(DistancePicture, ShadesGrowInProportion) {
  OccupancyGrid map = make_grid(52, 1, 1.0);
  map.at(0, 0) = Cell::occupied;
  const DistanceMap distances = make_distance_map(map, Cell::occupied);
  const PngImage image = decode_png(distance_map_png(distances));
  for (int x = 0; x < 52; ++x)
    EXPECT_EQ(gray_at(image, x, 0), 255 * distances.at(x, 0) / distances.at(51, 0));
}

TEST(DistancePicture, CellsOfASmallMapHaveALineAround) {
  OccupancyGrid map = make_grid(2, 1, 1.0);
  map.at(0, 0) = Cell::occupied;
  const PngImage image = decode_png(distance_map_png(make_distance_map(map, Cell::occupied)));
  for (int x = 0; x < image.width; ++x) {
    EXPECT_EQ(gray_at(image, x, 0), 128);
    EXPECT_EQ(gray_at(image, x, 24), 128);
    EXPECT_EQ(gray_at(image, x, 1) == 128, x % 24 == 0) << x;
  }
}

}  // namespace
}  // namespace gridmerge
