// SPDX-License-Identifier: Apache-2.0
#include "io/png.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>
#include <sys/resource.h>

#include <string>

#include "io/image.hpp"
#include "io/png_builder.hpp"
#include "io/png_map.hpp"
#include "io/support.hpp"
#include "support/temporary_directory.hpp"

namespace gridmerge {

using namespace internal;
namespace {

using test::bytes;
using test::contains;
using test::png_chunk;
using test::PngBuilder;
using test::PngColor;
using Samples = std::vector<std::uint8_t>;
using Values = std::vector<std::uint16_t>;

constexpr std::size_t kLimit = 1000;

MapImage decode(const PngBuilder& builder) {
  return decode_image(builder.build(), kLimit);
}
std::string error_of(const std::string& png) {
  return test::message_of<std::runtime_error>([&] { decode_png(png, kLimit); });
}

PngBuilder two_by_two() {
  return {.width = 2, .height = 2, .rows = bytes({0, 100, 205, 255})};
}

TEST(Png, ReadsGray) {
  const PngImage image = decode_png(two_by_two().build());
  EXPECT_EQ(image.width, 2);
  EXPECT_EQ(image.height, 2);
  EXPECT_EQ(image.channels, 1);
  EXPECT_EQ(image.bit_depth, 8);
  EXPECT_EQ(image.samples, (Samples{0, 100, 205, 255}));
}

TEST(Png, TellsItsSizeInItsFirstTwentyFourBytes) {
  const std::string image = PngBuilder{.width = 70000, .height = 513, .rows = ""}.build();
  const std::optional<ImageSize> size = png_size(image.substr(0, 24));
  ASSERT_TRUE(size);
  EXPECT_EQ(size->width, 70000U);
  EXPECT_EQ(size->height, 513U);
  EXPECT_FALSE(png_size(image.substr(0, 23)));
}

TEST(Png, TellsThatAChannelHas16Bits) {
  const PngImage image =
      decode_png(PngBuilder{.width = 2, .bit_depth = 16, .rows = bytes({1, 2, 3, 4})}.build());
  EXPECT_EQ(image.bit_depth, 16);
  EXPECT_EQ(image.samples, (Samples{1, 2, 3, 4}));
}

TEST(Png, GrayBecomesLightness) {
  const MapImage image = decode(two_by_two());
  EXPECT_EQ(image.white, 255);
  EXPECT_EQ(image.lightness, (Values{0, 100, 205, 255}));
  EXPECT_TRUE(image.alpha.empty());
}

TEST(Png, GrayOfFewBitsSpansBlackToWhite) {
  const PngBuilder one{.width = 3, .height = 1, .bit_depth = 1, .rows = bytes({0b10100000})};
  EXPECT_EQ(decode(one).lightness, (Values{255, 0, 255}));
  const PngBuilder two{.width = 4, .height = 1, .bit_depth = 2, .rows = bytes({0b00011011})};
  EXPECT_EQ(decode(two).lightness, (Values{0, 85, 170, 255}));
  const PngBuilder four{.width = 2, .height = 1, .bit_depth = 4, .rows = bytes({0x0f})};
  EXPECT_EQ(decode(four).lightness, (Values{0, 255}));
}

TEST(Png, Gray16KeepsAllBits) {
  const MapImage image = decode({.width = 2, .bit_depth = 16, .rows = bytes({0x12, 0x34, 0xff, 0xff})});
  EXPECT_EQ(image.white, 65535);
  EXPECT_EQ(image.lightness, (Values{0x1234, 0xffff}));
}

TEST(Png, ColorsAreAveraged) {
  const MapImage image =
      decode({.width = 2, .color = PngColor::rgb, .rows = bytes({255, 0, 0, 205, 205, 205})});
  EXPECT_EQ(image.white, 765);
  EXPECT_EQ(image.lightness, (Values{255, 615}));  // a third, and 205 of 255
}

TEST(Png, ColorsOf16BitsAreAveragedWithoutOverflow) {
  const MapImage image = decode({.width = 2,
                                 .bit_depth = 16,
                                 .color = PngColor::rgb,
                                 .rows = bytes({255, 255, 255, 255, 255, 255, 0, 1, 0, 2, 0, 5})});
  EXPECT_EQ(image.white, 65535);
  EXPECT_EQ(image.lightness, (Values{65535, 3}));  // 8/3, rounded
}

TEST(Png, GrayAlphaAndRgbaKeepAlphaApart) {
  const MapImage gray = decode({.width = 2, .color = PngColor::gray_alpha, .rows = bytes({10, 255, 20, 7})});
  EXPECT_EQ(gray.lightness, (Values{10, 20}));
  EXPECT_EQ(gray.alpha, (Samples{255, 7}));
  const MapImage color =
      decode({.width = 2, .color = PngColor::rgba, .rows = bytes({1, 2, 3, 255, 4, 5, 6, 0})});
  EXPECT_EQ(color.lightness, (Values{6, 15}));
  EXPECT_EQ(color.alpha, (Samples{255, 0}));
}

TEST(Png, Alpha16IsOpaqueOnlyWhenFull) {
  const MapImage image = decode({.width = 2,
                                 .bit_depth = 16,
                                 .color = PngColor::gray_alpha,
                                 .rows = bytes({0, 9, 255, 255, 0, 9, 255, 254})});
  EXPECT_EQ(image.lightness, (Values{9, 9}));
  EXPECT_EQ(image.alpha, (Samples{255, 254}));
}

TEST(Png, PaletteBecomesItsColors) {
  PngBuilder builder{.width = 3, .bit_depth = 2, .color = PngColor::palette, .rows = bytes({0b00011000})};
  builder.palette = bytes({0, 0, 0, 205, 205, 205, 255, 255, 255});
  EXPECT_EQ(decode(builder).lightness, (Values{0, 615, 765}));
  EXPECT_TRUE(decode(builder).alpha.empty());
  builder.transparency = bytes({255, 0});  // the entries left out are opaque
  EXPECT_EQ(decode(builder).lightness, (Values{0, 615, 765}));
  EXPECT_EQ(decode(builder).alpha, (Samples{255, 0, 255}));
}

TEST(Png, TransparentColorsBecomeAlpha) {
  PngBuilder gray = two_by_two();
  gray.transparency = bytes({0, 205});
  EXPECT_EQ(decode(gray).alpha, (Samples{255, 255, 0, 255}));
  PngBuilder color{.width = 2, .color = PngColor::rgb, .rows = bytes({1, 2, 3, 1, 2, 4})};
  color.transparency = bytes({0, 1, 0, 2, 0, 3});
  EXPECT_EQ(decode(color).alpha, (Samples{0, 255}));
}

TEST(Png, GammaChangesNothing) {
  const std::string plain = two_by_two().build();
  std::string with_gamma = plain;
  with_gamma.insert(8 + 25, png_chunk("gAMA", bytes({0, 1, 0x86, 0xa0})));  // after the header; 1.0
  EXPECT_EQ(decode_image(with_gamma, kLimit).lightness, (Values{0, 100, 205, 255}));
}

TEST(Png, ReadsInterlaced) {
  const MapImage image = decode_image(test::read_file(GRIDMERGE_TEST_DATA "/interlaced.png"), kLimit);
  ASSERT_EQ(image.width, 9);
  ASSERT_EQ(image.height, 7);
  for (int row = 0; row < 7; ++row) {
    for (int column = 0; column < 9; ++column) {
      EXPECT_EQ(image.lightness[static_cast<std::size_t>(row * 9 + column)], 10 * row + 20 * column);
    }
  }
}

TEST(Png, IgnoresWhatFollowsTheImage) {
  EXPECT_EQ(decode_png(two_by_two().build() + "more").samples, (Samples{0, 100, 205, 255}));
}

TEST(Png, EveryTruncationIsRefused) {
  const std::string png = two_by_two().build();
  for (std::size_t length = 0; length < png.size(); ++length) {
    EXPECT_THROW(decode_png(png.substr(0, length)), std::runtime_error) << length;
  }
}

TEST(Png, EveryFlippedByteIsRefusedOrHarmless) {
  const std::string png = two_by_two().build();
  for (std::size_t i = 0; i < png.size(); ++i) {
    std::string broken = png;
    broken[i] = static_cast<char>(broken[i] ^ 0x20);
    try {
      EXPECT_EQ(decode_png(broken, kLimit).samples.size(), 4u) << i;
    } catch (const std::runtime_error&) {
    }
  }
}

TEST(Png, RefusesSizesBeyondTheLimitBeforeTakingMemory) {
  PngBuilder builder = two_by_two();
  builder.width = builder.height = 65536;
  EXPECT_TRUE(contains(error_of(builder.build()), "65536 x 65536 pixels exceed the limit of 1000"));
  builder.width = builder.height = 0x7fffffff;
  EXPECT_TRUE(contains(error_of(builder.build()), "exceed the limit"));
  EXPECT_NO_THROW(decode_png(two_by_two().build(), 4));
  EXPECT_THROW(decode_png(two_by_two().build(), 3), std::runtime_error);
}

// Nearly 2 GB that are not there.
TEST(Png, TakesNoMemoryForTheLengthThatATextClaims) {
  const std::string png = PngBuilder{.rows = bytes({0x80})}.build();
  const std::size_t after_header = 8 + 25;
  const std::string claim = bytes({0x69, 0x7f, 0x7f, 0x45}) + "zTXtkey";
  rusage before{}, after{};
  ::getrusage(RUSAGE_SELF, &before);
  EXPECT_NE(error_of(png.substr(0, after_header) + claim), "");
  ::getrusage(RUSAGE_SELF, &after);
  EXPECT_LT(after.ru_maxrss - before.ru_maxrss, 200'000) << "KB";
}

TEST(Png, RefusesLargeSizesThatTheDataCannotFill) {
  PngBuilder builder = two_by_two();
  builder.width = builder.height = 16000;
  builder.bit_depth = 16;
  builder.color = PngColor::rgba;  // 2 GiB, if taken at its word
  const std::string message = test::message_of<std::runtime_error>([&] { decode_png(builder.build()); });
  EXPECT_EQ(message, "the image data end early");
}

TEST(Png, RefusesBadFilesAndSaysWhy) {
  EXPECT_TRUE(contains(error_of(""), "ends early"));
  EXPECT_TRUE(contains(error_of("P5 1 1 255\na and more"), "Not a PNG"));
  PngBuilder builder = two_by_two();
  builder.width = 0;
  EXPECT_TRUE(contains(error_of(builder.build()), "not a readable PNG"));
  builder = two_by_two();
  builder.rows.resize(2);
  builder.height = 1;
  std::string too_few_rows = builder.build();
  too_few_rows.replace(8, 25, two_by_two().build().substr(8, 25));  // the header of two rows
  EXPECT_TRUE(contains(error_of(too_few_rows), "not a readable PNG"));
  std::string checksum = two_by_two().build();
  checksum[checksum.size() - 13] =
      static_cast<char>(checksum[checksum.size() - 13] ^ 1);  // the last of IDAT's
  EXPECT_TRUE(contains(error_of(checksum), "CRC"));
}

RC_GTEST_PROP(Png, ReadsWhatItWrites, ()) {
  PngImage image;
  image.width = *rc::gen::inRange(1, 20);
  image.height = *rc::gen::inRange(1, 20);
  image.channels = *rc::gen::inRange(1, 5);
  image.samples =
      *rc::gen::container<Samples>(static_cast<std::size_t>(image.width * image.height * image.channels),
                                   rc::gen::arbitrary<std::uint8_t>());
  const PngImage read = decode_png(encode_png(image));
  RC_ASSERT(read.width == image.width);
  RC_ASSERT(read.height == image.height);
  RC_ASSERT(read.channels == image.channels);
  RC_ASSERT(read.bit_depth == 8);
  RC_ASSERT(read.samples == image.samples);
}

TEST(Png, WritesNothingBehindTheImage) {
  EXPECT_TRUE(encode_png({.width = 2, .height = 1, .channels = 3, .samples = Samples(6)})
                  .ends_with(png_chunk("IEND", "")));
}

TEST(Png, WritesOnlyWhatFits) {
  const PngImage good{.width = 2, .height = 1, .channels = 3, .samples = Samples(6)};
  EXPECT_NO_THROW(encode_png(good));
  for (auto spoil : {+[](PngImage& i) { i.width = 0; }, +[](PngImage& i) { i.height = -1; },
                     +[](PngImage& i) { i.channels = 0; }, +[](PngImage& i) { i.channels = 5; },
                     +[](PngImage& i) { i.bit_depth = 16; }, +[](PngImage& i) { i.samples.pop_back(); }}) {
    PngImage bad = good;
    spoil(bad);
    EXPECT_THROW(encode_png(bad), std::invalid_argument);
  }
}

}  // namespace
}  // namespace gridmerge
