// SPDX-License-Identifier: Apache-2.0
#include "io/bmp.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <ostream>
#include <string>

#include "io/image_builder.hpp"
#include "io/parse_error.hpp"
#include "io/png_builder.hpp"
#include "io/support.hpp"

namespace gridmerge {

using namespace internal;
namespace {

using test::BmpBuilder;
using test::bytes;
using test::contains;
using Values = std::vector<std::uint16_t>;

constexpr std::size_t kLimit = 1000;

MapImage decode(const BmpBuilder& bmp) {
  return decode_bmp(bmp.build(), kLimit);
}

const std::string kBlackGrayWhite = bytes({0, 0, 0, 0, 205, 205, 205, 0, 1, 2, 4, 0});

TEST(Bmp, ReadsColorsBottomRowFirst) {
  const MapImage image =
      decode({.width = 1, .height = 2, .palette = {}, .rows = bytes({1, 2, 4, 0, 255, 255, 255, 0})});
  EXPECT_EQ(image.width, 1);
  EXPECT_EQ(image.height, 2);
  EXPECT_EQ(image.white, 765);
  EXPECT_EQ(image.lightness, (Values{765, 7}));
  EXPECT_TRUE(image.alpha.empty());
  EXPECT_FALSE(image.is_lossy);
}

TEST(Bmp, OrTopRowFirst) {
  EXPECT_EQ(decode({.width = 1, .height = -2, .palette = {}, .rows = bytes({1, 2, 4, 0, 255, 255, 255, 0})})
                .lightness,
            (Values{7, 765}));
}

TEST(Bmp, ReadsPalettesOf8And4And1Bits) {
  EXPECT_EQ(
      decode({.width = 3, .bits = 8, .colors = 3, .palette = kBlackGrayWhite, .rows = bytes({0, 1, 2, 9})})
          .lightness,
      (Values{0, 615, 7}));
  EXPECT_EQ(
      decode(
          {.width = 3, .bits = 4, .colors = 3, .palette = kBlackGrayWhite, .rows = bytes({0x12, 0x0f, 9, 9})})
          .lightness,
      (Values{615, 7, 0}));
  EXPECT_EQ(decode({.width = 9,
                    .bits = 1,
                    .palette = kBlackGrayWhite.substr(0, 8),
                    .rows = bytes({0b10010110, 0b10000000, 0, 0})})
                .lightness,
            (Values{615, 0, 0, 615, 0, 615, 615, 0, 615}));
}

TEST(Bmp, TheFourthByteIsAlphaOnlyWhereTheHeaderSaysSo) {
  const std::string pixels = bytes({10, 10, 10, 0, 20, 20, 20, 255});
  EXPECT_TRUE(decode({.width = 2, .bits = 32, .palette = {}, .rows = pixels}).alpha.empty());
  const std::string masks = bytes({0, 0, 255, 0, 0, 255, 0, 0, 255, 0, 0, 0, 0, 0, 0, 255});
  BmpBuilder bmp{
      .width = 2, .bits = 32, .compression = 3, .palette = masks, .rows = pixels, .header_size = 56};
  EXPECT_EQ(decode(bmp).alpha, (std::vector<std::uint8_t>{0, 255}));
  bmp.rows[7] = 0;  // no pixel would be seen: the writer knew of no alpha
  EXPECT_TRUE(decode(bmp).alpha.empty());
  EXPECT_EQ(decode(bmp).lightness, (Values{30, 60}));
}

TEST(Bmp, OfAPaletteNoMoreIsReadThanItsBitsCanName) {
  // The header promises 300 colours, the bits can name two.
  EXPECT_EQ(decode({.width = 2,
                    .bits = 1,
                    .colors = 300,
                    .palette = kBlackGrayWhite.substr(0, 8),
                    .rows = bytes({0b01000000, 0, 0, 0})})
                .lightness,
            (Values{0, 615}));
}

TEST(Bmp, ItsPaletteLiesBehindAHeaderOfAnySize) {
  const std::string rest_of_header(16, '\7');  // of 56 bytes
  EXPECT_EQ(decode({.width = 2,
                    .bits = 8,
                    .colors = 3,
                    .palette = rest_of_header + kBlackGrayWhite,
                    .rows = bytes({1, 2, 0, 0}),
                    .header_size = 56})
                .lightness,
            (Values{615, 7}));
}

TEST(Bmp, RowsOfWholeWordsHaveNothingToFillThemUp) {
  const std::string two_rows =
      bytes({1, 1, 1, 2, 2, 2, 3, 3, 3, 4, 4, 4, 5, 5, 5, 6, 6, 6, 7, 7, 7, 8, 8, 8});
  EXPECT_EQ(decode({.width = 4, .height = 2, .palette = {}, .rows = two_rows}).lightness,
            (Values{15, 18, 21, 24, 3, 6, 9, 12}));
  const auto cut = [&](std::size_t size) {
    return test::message_of<ParseError>(
        [&] { decode({.width = 4, .height = 2, .palette = {}, .rows = two_rows.substr(0, size)}); });
  };
  EXPECT_TRUE(contains(cut(23), "end early"));
}

TEST(Bmp, AHeaderThatIsCutAnywhereIsSaidToEnd) {
  const std::string whole =
      BmpBuilder{.bits = 8, .colors = 3, .palette = kBlackGrayWhite, .rows = bytes({0, 0, 0, 0})}.build();
  const std::size_t palette_end = 14 + 40 + 3 * 4 - 1;  // nobody needs the last colour's fourth byte
  for (std::size_t size = 18; size < palette_end; ++size) {
    const std::string error =
        test::message_of<ParseError>([&] { decode_bmp(whole.substr(0, size), kLimit); });
    EXPECT_EQ(error, "the file ends within its header") << size;
  }
}

TEST(Bmp, TellsItsSizeWhicheverRowComesFirst) {
  for (const std::int32_t height : {5, -5}) {
    const ImageSize size =
        bmp_size(BmpBuilder{.width = 7, .height = height, .palette = {}, .rows = {}}.build());
    EXPECT_EQ(size.width, 7u);
    EXPECT_EQ(size.height, 5u);
  }
}

TEST(Bmp, IsToldByItsFirstBytes) {
  EXPECT_TRUE(looks_like_bmp(BmpBuilder{.palette = {}, .rows = {}}.build().substr(0, 18)));
  for (const std::string other : {"", "BM", "BM: 3\nimage: a.pgm\nresolution: 0.05\n"})
    EXPECT_FALSE(looks_like_bmp(other)) << other;
}

struct BadBmp {
  const char* name;
  BmpBuilder bmp;
  const char* message;

  friend void PrintTo(const BadBmp& bad, std::ostream* out) { *out << bad.name; }
};

class BmpRefuses : public testing::TestWithParam<BadBmp> {};

TEST_P(BmpRefuses, AndSaysWhy) {
  EXPECT_TRUE(contains(test::message_of<ParseError>([&] { decode(GetParam().bmp); }), GetParam().message));
}

constexpr std::int32_t kMin = std::numeric_limits<std::int32_t>::min();

INSTANTIATE_TEST_SUITE_P(
    BadFiles, BmpRefuses,
    testing::Values(
        BadBmp{"HugeSizes", {.width = 65536, .height = 65536, .palette = {}, .rows = {}}, "exceed the limit"},
        BadBmp{
            "TheLowestHeight", {.width = 1, .height = kMin, .palette = {}, .rows = {}}, "exceed the limit"},
        BadBmp{"NegativeWidth", {.width = -1, .palette = {}, .rows = {}}, "width is negative"},
        BadBmp{"NoPixels", {.width = 0, .palette = {}, .rows = {}}, "no pixels"},
        BadBmp{"CutShort", {.width = 2, .palette = {}, .rows = bytes({1, 2, 3, 4, 5, 6, 0})}, "end early"},
        BadBmp{"RowsBeyondTheEnd",
               {.palette = {}, .rows = bytes({1, 2, 3, 0}), .raster_shift = 1 << 30},
               "end early"},
        BadBmp{"Compressed", {.bits = 8, .compression = 1, .palette = {}, .rows = {}}, "compressed BMP"},
        BadBmp{"Of16Bits", {.bits = 16, .palette = {}, .rows = bytes({1, 2, 0, 0})}, "BMP of 16 bits"},
        BadBmp{"UnusualMasks",
               {.bits = 32, .compression = 3, .palette = std::string(12, 'x'), .rows = bytes({1, 2, 3, 0})},
               "unusual order"},
        BadBmp{
            "NoPalette", {.bits = 8, .palette = {}, .rows = bytes({0, 0, 0, 0})}, "ends within its header"},
        BadBmp{"OutsideThePalette",
               {.bits = 8, .colors = 2, .palette = kBlackGrayWhite.substr(0, 8), .rows = bytes({2, 0, 0, 0})},
               "colour 2 is not in the palette"},
        BadBmp{"OfOs2", {.palette = {}, .rows = {}, .header_size = 12}, "BMP of OS/2"}),
    [](const auto& instance) { return std::string(instance.param.name); });

RC_GTEST_PROP(Bmp, ReadsWhatIsWritten, ()) {
  const int width = *rc::gen::inRange(1, 20), height = *rc::gen::inRange(1, 20);
  const auto values = *rc::gen::container<std::vector<std::uint8_t>>(static_cast<std::size_t>(width * height),
                                                                     rc::gen::arbitrary<std::uint8_t>());
  const MapImage image = decode_bmp(test::gray_bmp(width, height, values), values.size());
  RC_ASSERT(image.width == width);
  RC_ASSERT(image.height == height);
  for (std::size_t i = 0; i < values.size(); ++i) RC_ASSERT(image.lightness[i] == 3 * values[i]);
}

RC_GTEST_PROP(Bmp, WhatIsCutOrChangedIsRefusedOrRead, ()) {
  std::string text = test::gray_bmp(3, 3, std::vector<std::uint8_t>(9, 205));
  for (int i = 0; i < 3; ++i)
    text[*rc::gen::inRange<std::size_t>(0, text.size())] = *rc::gen::arbitrary<char>();
  text.resize(*rc::gen::inRange<std::size_t>(0, text.size() + 1));
  try {
    const MapImage image = decode_bmp(text, kLimit);
    RC_ASSERT(image.lightness.size() ==
              static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height));
  } catch (const ParseError&) {
  }
}

}  // namespace
}  // namespace gridmerge
