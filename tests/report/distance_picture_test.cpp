// SPDX-License-Identifier: Apache-2.0
#include "report/distance_picture.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <utility>

#include "gridmerge/grid/occupancy_grid.hpp"
#include "io/png.hpp"
#include "report/canvas.hpp"

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

/// A number in the middle of its cell, as letters are drawn elsewhere.
void write_in_cell(Canvas& canvas, int column, int row, const std::string& number, Colour ink) {
  const int left = (24 - text_width(number, TextSize::tiny)) / 2;
  canvas.write(24 * column + left, 24 * row + 4, TextSize::tiny, number, ink);
}

TEST(DistancePicture, NumbersStandInTheMiddleAndAreReadable) {
  constexpr Colour kBlack{0, 0, 0}, kWhite{255, 255, 255}, kLine{128, 128, 128};
  // The shades of 125 and 126 of 250 and 251 are 127 and 128: white letters up to there, then black ones.
  for (const auto& [middle, most, shade] : {std::array<int, 3>{125, 250, 127}, {126, 251, 128}}) {
    DistanceMap map;
    map.width = map.height = 2;
    map.distances = {0, static_cast<std::uint16_t>(middle), static_cast<std::uint16_t>(most), kNoDistance};
    const auto gray = static_cast<std::uint8_t>(shade);
    Canvas expected(2 * 24 + 1, 2 * 24 + 1, kLine);
    expected.fill(1, 25, 23, 23, kBlack);  // the first row is the lower one
    expected.fill(25, 25, 23, 23, {gray, gray, gray});
    expected.fill(1, 1, 23, 23, kWhite);
    expected.fill(25, 1, 23, 23, kWhite);
    write_in_cell(expected, 0, 1, "0", kWhite);
    write_in_cell(expected, 1, 1, std::to_string(middle), shade < 128 ? kWhite : kBlack);
    write_in_cell(expected, 0, 0, std::to_string(most), kBlack);
    write_in_cell(expected, 1, 0, "inf", kBlack);
    const PngImage image = decode_png(distance_map_png(map));
    EXPECT_TRUE(image.samples == expected.image().samples) << middle;
  }
}

TEST(DistancePicture, WhereAllIsNearNothingIsDividedByZero) {
  DistanceMap map;
  map.width = 41;
  map.height = 1;
  map.distances.assign(41, 0);
  map.distances[40] = kNoDistance;
  const PngImage image = decode_png(distance_map_png(map));
  EXPECT_EQ(gray_at(image, 0, 0), 0);
  EXPECT_EQ(gray_at(image, 39, 0), 0);
  EXPECT_EQ(gray_at(image, 40, 0), 255);
}

}  // namespace
}  // namespace gridmerge
