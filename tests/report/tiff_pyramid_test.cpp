// SPDX-License-Identifier: Apache-2.0
#include "report/tiff_pyramid.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "io/atomic_file.hpp"
#include "io/support.hpp"
#include "report/tiff_reader.hpp"
#include "support/temporary_directory.hpp"

namespace gridmerge {

using namespace internal;
using namespace test;
namespace {

/// The pictures of what is drawn from these pixels, top row first.
std::vector<TiffPicture> drawn(int width, int height, const std::vector<std::uint8_t>& pixels) {
  const TemporaryDirectory directory;
  const std::string file = directory.file("x.tif");
  TiffPyramid pyramid(file, width, height);
  auto from = pixels.begin();
  while (pyramid.rows_left() > 0) {
    const auto to = from + static_cast<std::ptrdiff_t>(pyramid.rows_left()) * width;
    pyramid.add_rows({from, to});
    from = to;
  }
  StagedFile staged(file);
  pyramid.write(staged, {{1.5, 20.25}, 0.05, "frame of a", "words"});
  staged.commit();
  EXPECT_EQ(directory.names(), std::vector<std::string>{"x.tif"});
  return TiffReader(read_file(file)).pictures();
}

/// The strongest of two by two, by hand.
std::vector<std::uint8_t> halved(int width, int height, const std::vector<std::uint8_t>& pixels) {
  std::vector<std::uint8_t> half;
  for (int y = 0; y < height; y += 2) {
    for (int x = 0; x < width; x += 2) {
      int most = -1;
      for (int dy = 0; dy < 2; ++dy) {
        for (int dx = 0; dx < 2; ++dx) {
          if (x + dx >= width || y + dy >= height) continue;
          const int pixel = pixels[static_cast<std::size_t>((y + dy) * width + x + dx)];
          if (pixel != TiffPyramid::kUnknown) most = std::max(most, pixel);
        }
      }
      half.push_back(static_cast<std::uint8_t>(most < 0 ? TiffPyramid::kUnknown : most));
    }
  }
  return half;
}

TEST(TiffPyramid, HoldsThePictureAndItsOverviews) {
  std::mt19937 random(1);
  const std::vector<std::pair<int, int>> sizes{{1, 1},      {3, 700},    {512, 512}, {513, 1},
                                               {1025, 513}, {700, 1537}, {1, 2049},  {514, 515}};
  for (const auto& [width, height] : sizes) {
    SCOPED_TRACE(std::to_string(width) + " x " + std::to_string(height));
    std::vector<std::uint8_t> pixels(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
    for (std::uint8_t& pixel : pixels)
      pixel = random() % 30 != 0 ? TiffPyramid::kUnknown : static_cast<std::uint8_t>(random() % 101);
    const std::vector<TiffPicture> pictures = drawn(width, height, pixels);
    int level_width = width, level_height = height;
    for (std::size_t i = 0; i < pictures.size(); ++i) {
      const TiffPicture& picture = pictures[i];
      ASSERT_EQ(picture.width(), level_width);
      ASSERT_EQ(picture.height(), level_height);
      ASSERT_TRUE(picture.pixels == pixels) << i;
      EXPECT_EQ(picture.number(254), i == 0 ? 0u : 1u);
      EXPECT_EQ(picture.texts.at(42113), "255");
      // A reader from afar finds overviews first: the smaller, the nearer to the beginning.
      if (i > 0) {
        EXPECT_LT(picture.number(324), pictures[i - 1].number(324));
      }
      pixels = halved(level_width, level_height, pixels);
      level_width = (level_width + 1) / 2;
      level_height = (level_height + 1) / 2;
    }
    EXPECT_LE(std::max(pictures.back().width(), pictures.back().height()), TiffPyramid::kTile);
    if (pictures.size() > 1) {
      EXPECT_GT(std::max(pictures[pictures.size() - 2].width(), pictures[pictures.size() - 2].height()),
                TiffPyramid::kTile);
    }
  }
}

// Each pair that may meet, beside each other and above each other, at the end of rows of odd length.
TEST(TiffPyramid, OfTwoPixelsTheStrongerStays) {
  constexpr std::uint8_t kNone = TiffPyramid::kUnknown;
  std::vector<std::uint8_t> pixels(std::size_t{515} * 3, kNone);
  const auto at = [&](int column, int row) -> std::uint8_t& {
    return pixels[static_cast<std::size_t>(row * 515 + column)];
  };
  at(0, 0) = 7;                  // alone, upper left,
  at(3, 0) = 8;                  // upper right,
  at(4, 1) = 9;                  // lower left,
  at(7, 1) = 10;                 // lower right
  at(8, 0) = 0, at(9, 0) = 100;  // beside each other, both ways
  at(10, 1) = 100, at(11, 1) = 0;
  at(12, 0) = 20, at(12, 1) = 30;  // above each other, both ways
  at(15, 0) = 30, at(15, 1) = 20;
  at(514, 0) = 40, at(514, 1) = 50;  // in the last column, which has none beside it
  at(0, 2) = 60, at(1, 2) = 70;      // in the last row, which has none below it
  at(514, 2) = 0;
  const std::vector<TiffPicture> pictures = drawn(515, 3, pixels);
  ASSERT_EQ(pictures.size(), 2u);
  EXPECT_TRUE(pictures[0].pixels == pixels);
  ASSERT_EQ(pictures[1].width(), 258);
  ASSERT_EQ(pictures[1].height(), 2);
  std::vector<std::uint8_t> expected(std::size_t{258} * 2, kNone);
  const std::vector<std::uint8_t> first{7, 8, 9, 10, 100, 100, 30, 30};
  std::copy(first.begin(), first.end(), expected.begin());
  expected[257] = 50;
  expected[258] = 70;
  expected[258 + 257] = 0;
  EXPECT_EQ(pictures[1].pixels, expected);
}

// The rows of a tile are asked for at a time; a level below has its tiles once it has enough rows.
TEST(TiffPyramid, IsDrawnARowOfTilesAtATime) {
  const TemporaryDirectory directory;
  TiffPyramid pyramid(directory.file("x.tif"), 2, 1026);
  EXPECT_EQ(pyramid.width(), 2);
  EXPECT_EQ(pyramid.height(), 1026);
  for (const int rows : {512, 512, 2}) {
    ASSERT_EQ(pyramid.rows_left(), rows);
    pyramid.add_rows(std::vector<std::uint8_t>(static_cast<std::size_t>(rows) * 2, 5));
  }
  EXPECT_EQ(pyramid.rows_left(), 0);
}

TEST(TiffPyramid, SaysWhereItLies) {
  const TiffPicture picture = drawn(2, 1, {0, 100}).at(0);
  EXPECT_EQ(picture.real(33550, 0), 0.05);
  EXPECT_EQ(picture.real(33550, 1), 0.05);
  EXPECT_EQ(picture.real(33922, 3), 1.5);
  EXPECT_EQ(picture.real(33922, 4), 20.25);
  EXPECT_EQ(picture.texts.at(34737), "frame of a|");
  EXPECT_EQ(picture.texts.at(270), "words");
  // White is free and black is a wall.
  const auto& palette = picture.tags.at(320);
  ASSERT_EQ(palette.size(), 768u);
  EXPECT_EQ(palette[0], 65535u);
  EXPECT_EQ(palette[256 + 100], 0u);
}

// What readers go by, number by number, as the formats' documentation has it.
TEST(TiffPyramid, SaysHowItIsToBeRead) {
  using Values = std::vector<std::uint64_t>;
  std::vector<std::uint8_t> pixels(std::size_t{600} * 2, 7);
  const std::vector<TiffPicture> pictures = drawn(600, 2, pixels);
  ASSERT_EQ(pictures.size(), 2u);
  for (const TiffPicture& picture : pictures) {
    EXPECT_EQ(picture.tags.at(258), Values{8});    // bits
    EXPECT_EQ(picture.tags.at(259), Values{8});    // Adobe deflate
    EXPECT_EQ(picture.tags.at(262), Values{3});    // of a palette
    EXPECT_EQ(picture.tags.at(277), Values{1});    // channels
    EXPECT_EQ(picture.tags.at(322), Values{512});  // a tile's width
    EXPECT_EQ(picture.tags.at(339), Values{1});    // whole numbers from 0 on
    const Values& palette = picture.tags.at(320);
    ASSERT_EQ(palette.size(), 768u);
    for (std::size_t channel = 0; channel < 3; ++channel) {
      for (std::size_t value = 0; value < 256; ++value) {
        const std::uint64_t gray = 65535 - 65535 * value / 100;
        EXPECT_EQ(palette[256 * channel + value], value <= 100 ? gray : channel == 2 ? 0xD2D2u : 0xCDCDu);
      }
    }
  }
  EXPECT_EQ(pictures[0].texts.at(305), "gridmerge");
  for (const std::size_t i : {0u, 1u, 2u, 5u}) EXPECT_EQ(pictures[0].real(33922, i), 0.0);
  EXPECT_EQ(pictures[0].real(33550, 2), 0.0);
  // GeoTIFF 1.1: version 1.1.1 with four keys: a model of its own, a pixel is an area, a citation of 11
  // characters, and metres.
  EXPECT_EQ(pictures[0].tags.at(34735),
            (Values{1, 1, 1, 4, 1024, 0, 1, 32767, 1025, 0, 1, 1, 1026, 34737, 11, 0, 3076, 0, 1, 9001}));
  EXPECT_EQ(pictures[1].tags.count(34735), 0u);
}

}  // namespace
}  // namespace gridmerge
