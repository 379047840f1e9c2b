// SPDX-License-Identifier: Apache-2.0
#include "io/pnm.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <limits>
#include <ostream>
#include <string>

#include "io/image.hpp"
#include "io/parse_error.hpp"
#include "io/png_builder.hpp"
#include "io/support.hpp"

namespace gridmerge {

using namespace internal;
namespace {

using test::bytes;
using test::contains;
using Values = std::vector<std::uint16_t>;

constexpr std::size_t kLimit = 1000;

MapImage decode(const std::string& text) {
  return decode_pnm(text, kLimit);
}
std::string error_of(const std::string& text) {
  return test::message_of<ParseError>([&] { decode_pnm(text, kLimit); });
}

TEST(Pgm, ReadsPlain) {
  const MapImage image = decode("P2\n3 2\n9\n0 1 2\n7 8 9\n");
  EXPECT_EQ(image.width, 3);
  EXPECT_EQ(image.height, 2);
  EXPECT_EQ(image.white, 9);
  EXPECT_EQ(image.lightness, (Values{0, 1, 2, 7, 8, 9}));
  EXPECT_TRUE(image.alpha.empty());
}

TEST(Pgm, ReadsRaw) {
  const MapImage image = decode("P5 2 2 255\n" + bytes({0, 10, 205, 255}));
  EXPECT_EQ(image.white, 255);
  EXPECT_EQ(image.lightness, (Values{0, 10, 205, 255}));  // 10 is a pixel, not a line's end
}

TEST(Pgm, ReadsRawOf16BitsBigEndian) {
  const MapImage image = decode("P5 2 1 65535 " + bytes({0x12, 0x34, 0xff, 0xff}));
  EXPECT_EQ(image.white, 65535);
  EXPECT_EQ(image.lightness, (Values{0x1234, 0xffff}));
}

TEST(Pgm, TakesTwoBytesFromMaximum256On) {
  EXPECT_EQ(decode("P5 1 1 255\n" + bytes({1})).lightness, Values{1});
  EXPECT_EQ(decode("P5 1 1 256\n" + bytes({1, 0})).lightness, Values{256});
}

TEST(Pgm, ReadsPlainOf16Bits) {
  EXPECT_EQ(decode("P2 2 1 65535 65535 300").lightness, (Values{65535, 300}));
}

TEST(Pgm, TakesAnyMaximum) {
  EXPECT_EQ(decode("P2 2 1 1 0 1").white, 1);
  EXPECT_EQ(decode("P5 1 1 100\n" + bytes({100})).lightness, Values{100});
}

TEST(Pgm, SkipsComments) {
  EXPECT_EQ(decode("P5\n# CREATOR: map_saver 0.050 m/pix\n2 1\n255\n" + bytes({7, 8})).lightness,
            (Values{7, 8}));
  EXPECT_EQ(decode("P5#a\n2#b\n#c\n 1# 9 9\n255#d\n" + bytes({7, 8})).lightness, (Values{7, 8}));
  EXPECT_EQ(decode("P2 2 1 255 # first\n 7 # second\n 8").lightness, (Values{7, 8}));
}

TEST(Pgm, TakesExactlyOneSpaceBeforeRawData) {
  EXPECT_EQ(decode("P5 2 1 255 " + bytes({32, 10})).lightness, (Values{32, 10}));
}

TEST(Pgm, TakesWindowsLineEnds) {
  EXPECT_EQ(decode("P5\r\n2 1\r\n255\r\n" + bytes({7, 8})).lightness, (Values{7, 8}));
  EXPECT_EQ(decode("P2\r\n# c\r\n2 1\r\n255\r\n7 8\r\n").lightness, (Values{7, 8}));
  EXPECT_EQ(decode("P5 2 1 255\r" + bytes({10, 8})).lightness,
            (Values{10, 8}));  // here 10 is the first pixel
}

TEST(Pgm, IgnoresWhatFollowsTheLastPixel) {
  EXPECT_EQ(decode("P5 1 1 255\n" + bytes({7, 1, 2, 3})).lightness, Values{7});
  EXPECT_EQ(decode("P2 1 1 255\n7\nP2 1 1 255 8").lightness, Values{7});
}

TEST(Pgm, SpacesAreThoseOfTheCLocale) {
  EXPECT_EQ(decode("P2\t2\v1\f255\r7\n8").lightness, (Values{7, 8}));
  EXPECT_TRUE(contains(error_of("P2 2 1 255 7\x0e"
                                "8"),
                       "not a whole number"));
  EXPECT_TRUE(contains(error_of("P2 2 1 255 7\x08"
                                "8"),
                       "not a whole number"));
  EXPECT_EQ(decode("P2 2 1 255 7#\n8").lightness, (Values{7, 8}));
}

TEST(Pgm, ASizeOf32BitsIsReadAndRefusedAsTooLarge) {
  EXPECT_TRUE(contains(error_of("P5 4294967295 1 255\n"), "4294967295 x 1 pixels exceed"));
}

TEST(Pgm, OfAWindowsHeadersTwoCharactersOneIsAPixelWhereItIsNeeded) {
  EXPECT_EQ(decode("P5 2 1 255\r\n" + bytes({8})).lightness, (Values{10, 8}));
  EXPECT_EQ(decode("P5 2 1 255\r\n" + bytes({8, 9})).lightness, (Values{8, 9}));
}

TEST(Pgm, TakesPlainNumbersOfOneDigit) {
  EXPECT_EQ(decode("P2 3 1 9 1 2 3").lightness, (Values{1, 2, 3}));
  EXPECT_EQ(decode("P2 1 1 9 3").lightness, (Values{3}));
}

TEST(Ppm, LightnessIsTheSumOfTheColors) {
  const MapImage raw = decode("P6 2 1 255\n" + bytes({1, 2, 4, 255, 255, 255}));
  EXPECT_EQ(raw.white, 765);
  EXPECT_EQ(raw.lightness, (Values{7, 765}));
  const MapImage plain = decode("P3 2 1 9  1 2 3  9 9 9");
  EXPECT_EQ(plain.white, 27);
  EXPECT_EQ(plain.lightness, (Values{6, 27}));
}

TEST(Ppm, OfDeepColorsItIsTheirMean) {
  const MapImage raw = decode("P6 2 1 65535\n" + bytes({0, 1, 0, 2, 0, 5, 255, 255, 255, 255, 255, 255}));
  EXPECT_EQ(raw.white, 65535);
  EXPECT_EQ(raw.lightness, (Values{3, 65535}));              // 8 / 3, rounded
  EXPECT_EQ(decode("P3 1 1 21845 21845 0 0").white, 65535);  // three of them fit
  EXPECT_EQ(decode("P3 1 1 21846 21846 0 0").white, 21846);
}

TEST(Pgm, IsToldByItsFirstBytes) {
  EXPECT_TRUE(looks_like_pnm("P2\n"));
  EXPECT_TRUE(looks_like_pnm("P5#"));
  EXPECT_TRUE(looks_like_pnm("P3\n"));
  EXPECT_TRUE(looks_like_pnm("P6 "));
  for (const char* other : {"", "P", "P5", "P4\n", "P1\n", "P55 ", "P5: key", "image: a.pgm"}) {
    EXPECT_FALSE(looks_like_pnm(other)) << other;
  }
}

struct BadPgm {
  const char* name;
  std::string text;
  const char* message;

  friend void PrintTo(const BadPgm& bad, std::ostream* out) { *out << bad.name; }
};

class PgmRefuses : public testing::TestWithParam<BadPgm> {};

TEST_P(PgmRefuses, AndSaysWhy) {
  EXPECT_TRUE(contains(error_of(GetParam().text), GetParam().message));
}

INSTANTIATE_TEST_SUITE_P(
    BadFiles, PgmRefuses,
    testing::Values(
        BadPgm{"OtherFormats", "P4 1 1 255\nabc", "not a PGM"},
        BadPgm{"HugeSizes", "P5\n65536 65536\n255\n", "65536 x 65536 pixels exceed the limit of 1000"},
        BadPgm{"SizesThatOverflow", "P5 4294967295 4294967295 255\n", "exceed the limit"},
        BadPgm{"SizesBeyond32Bits", "P5 4294967296 1 255\n", "width is too large"},
        BadPgm{"SizesBeyond64Bits", "P5 1 99999999999999999999999 255\n", "height is too large"},
        BadPgm{"ZeroWidth", "P5 0 5 255\n", "no pixels"}, BadPgm{"ZeroHeight", "P5 5 0 255\n", "no pixels"},
        BadPgm{"NegativeWidth", "P5 -3 2 255\nabcdef", "width is not a whole number"},
        BadPgm{"FractionalHeight", "P5 3 2.5 255\nabcdef", "height is not a whole number"},
        BadPgm{"WordForWidth", "P5 three 2 255\nabcdef", "width is not a whole number"},
        BadPgm{"NoMaximum", "P5 3 2\n", "ends before its maximum value"},
        BadPgm{"NoWidth", "P5\n# only a comment", "ends before its width"},
        BadPgm{"ZeroMaximum", "P5 1 1 0\na", "maximum value 0 is not in 1..65535"},
        BadPgm{"LargeMaximum", "P5 1 1 65536\nabcd", "maximum value 65536 is not in 1..65535"},
        BadPgm{"RawCutShort", "P5 3 2 255\nabcde", "end early: 5 bytes of 6"},
        BadPgm{"RawWithoutData", "P5 3 2 255", "end early: 0 bytes of 6"},
        BadPgm{"Raw16CutShort", "P5 3 2 256\nabcdefghijk", "end early: 11 bytes of 12"},
        BadPgm{"PlainCutShort", "P2 3 2 255\n1 2 3 4 5", "ends before its image data"},
        BadPgm{"PlainFarTooShort", "P2 30 30 255\n1 2 3 4 5", "end early"},
        BadPgm{"PlainWithWideNumbersCutShort", "P2 2 2 255\n100 200 100", "ends before its image data"},
        BadPgm{"PlainWithWords", "P2 2 1 255\n1 x", "image data is not a whole number"},
        BadPgm{"PlainWithNegatives", "P2 2 1 255\n1 -2", "image data is not a whole number"},
        BadPgm{"PlainAboveMaximum", "P2 2 1 100\n1 101", "value 101 exceeds the header's maximum 100"},
        BadPgm{"ColorsCutShort", "P6 1 2 255\nabcde", "end early: 5 bytes of 6"},
        BadPgm{"PlainColorsFarTooShort", "P3 30 30 255\n1 2 3 4 5", "end early"},
        BadPgm{"ColorAboveMaximum", "P6 1 1 100\n" + bytes({1, 2, 101}), "value 101 exceeds"},
        BadPgm{"RawAboveMaximum", "P5 2 1 100\n" + bytes({1, 101}), "value 101 exceeds"}),
    [](const auto& instance) { return std::string(instance.param.name); });

TEST(Pgm, TakesAsManyPixelsAsTheLimitAllows) {
  EXPECT_NO_THROW(decode_pnm("P2 2 2 9 1 2 3 4", 4));
  EXPECT_THROW(decode_pnm("P2 2 2 9 1 2 3 4", 3), ParseError);
}

TEST(Pgm, TakesNoSideThatAnIntCannotHold) {
  const auto decode_unlimited = [] {
    decode_pnm("P5 2147483648 1 255\n", std::numeric_limits<std::size_t>::max());
  };
  EXPECT_TRUE(contains(test::message_of<ParseError>(decode_unlimited), "exceed the limit"));
}

RC_GTEST_PROP(Pgm, ReadsWhatItWrites, ()) {
  const int width = *rc::gen::inRange(1, 20), height = *rc::gen::inRange(1, 20);
  const auto values = *rc::gen::container<std::vector<std::uint8_t>>(static_cast<std::size_t>(width * height),
                                                                     rc::gen::arbitrary<std::uint8_t>());
  const MapImage image = decode_pnm(encode_pgm(width, height, values), values.size());
  RC_ASSERT(image.width == width);
  RC_ASSERT(image.height == height);
  RC_ASSERT(image.white == 255);
  RC_ASSERT(image.lightness == Values(values.begin(), values.end()));
}

// What a file may have is read: three numbers a pixel, with spaces.
TEST(Pnm, OfAPlainPictureEnoughIsRead) {
  constexpr std::size_t kPixels = std::size_t{3000} * 3000, kLongest = sizeof("65535 65535 65535 ") - 1;
  EXPECT_GE(most_image_bytes("P3\n3000 3000\n65535\n", kPixels), kPixels * kLongest);
  EXPECT_GE(most_image_bytes("P2\n3000 3000\n65535\n", kPixels), kPixels * (sizeof("65535 ") - 1));
  EXPECT_LT(most_image_bytes("P6\n3000 3000\n65535\n", kPixels), kPixels * kLongest);
}

// Files end where their pixels do, but for what programs say of a picture: 64 MiB are enough for that.
TEST(Image, OfAnyOtherPictureAsMuchIsRead) {
  constexpr std::size_t kRest = std::size_t{64} << 20;
  EXPECT_EQ(most_image_bytes("P5\n30 20\n255\n", 600), 600 * 8 + kRest);
  EXPECT_EQ(most_image_bytes("P2\n30 20\n255\n", 600), 600 * 24 + kRest);
  EXPECT_EQ(most_image_bytes("\xff\xd8\xff\xe0", 600), kRest);  // a JPEG whose size is not told yet
  EXPECT_EQ(most_image_bytes("hello", 600), 5u);
  EXPECT_THROW(most_image_bytes("P5\n30 21\n255\n", 600), ParseError);
}

TEST(Image, HasNoMorePixelsThanAllowed) {
  constexpr std::size_t kAll = std::numeric_limits<std::size_t>::max();
  EXPECT_NO_THROW(check_image_size(30, 20, 600));
  EXPECT_THROW(check_image_size(30, 20, 599), ParseError);
  EXPECT_NO_THROW(check_image_size(2147483647, 1, kAll));
  EXPECT_NO_THROW(check_image_size(1, 2147483647, kAll));
  EXPECT_THROW(check_image_size(2147483648, 1, kAll), ParseError);
  EXPECT_THROW(check_image_size(1, 2147483648, kAll), ParseError);
  EXPECT_THROW(check_image_size(0, 1, kAll), ParseError);
  EXPECT_THROW(check_image_size(1, 0, kAll), ParseError);
}

}  // namespace
}  // namespace gridmerge
