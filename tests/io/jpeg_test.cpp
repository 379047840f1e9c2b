// SPDX-License-Identifier: Apache-2.0
#include "io/jpeg.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cstdlib>
#include <optional>
#include <string>
#include <string_view>

#include "io/image_builder.hpp"
#include "io/parse_error.hpp"
#include "io/support.hpp"

namespace gridmerge {

using namespace internal;
namespace {

using test::contains;

constexpr std::size_t kLimit = 10000;

// Left half and right half.
std::vector<std::uint8_t> halves(int width, int height, std::size_t channels, std::uint8_t left,
                                 std::uint8_t right) {
  std::vector<std::uint8_t> values;
  for (int row = 0; row < height; ++row) {
    for (int column = 0; column < width; ++column)
      values.insert(values.end(), channels, column < width / 2 ? left : right);
  }
  return values;
}

std::string error_of(const std::string& bytes) {
  return test::message_of<ParseError>([&] { decode_jpeg(bytes, kLimit); });
}

TEST(Jpeg, ReadsGray) {
  const MapImage image = decode_jpeg(test::gray_jpeg(32, 17, halves(32, 17, 1, 0, 205)), kLimit);
  EXPECT_EQ(image.width, 32);
  EXPECT_EQ(image.height, 17);
  EXPECT_EQ(image.white, 255);
  EXPECT_TRUE(image.is_lossy);
  ASSERT_EQ(image.lightness.size(), 32U * 17U);
  for (std::size_t i = 0; i < image.lightness.size(); ++i)
    EXPECT_LE(std::abs(image.lightness[i] - (i % 32 < 16 ? 0 : 205)), 4) << i;
}

TEST(Jpeg, ReadsColorsBaselineAndProgressive) {
  for (const bool progressive : {false, true}) {
    const MapImage image =
        decode_jpeg(test::rgb_jpeg(32, 16, halves(32, 16, 3, 254, 0), progressive), kLimit);
    EXPECT_EQ(image.white, 765);
    ASSERT_EQ(image.lightness.size(), 32U * 16U);
    EXPECT_LE(std::abs(image.lightness.front() - 762), 12);
    EXPECT_LE(image.lightness.back(), 12);
  }
}

TEST(Jpeg, TellsItsSizeInItsFirstBytes) {
  for (const bool progressive : {false, true}) {
    std::string image = test::rgb_jpeg(33, 17, halves(33, 17, 3, 254, 0), progressive);
    const std::string note = std::string("\xff\xfe\xc3\x50", 4) + std::string(49998, '\xc0');  // a comment
    image.insert(2, note + "stray");
    const std::optional<ImageSize> size = jpeg_size(image);
    ASSERT_TRUE(size);
    EXPECT_EQ(size->width, 33U);
    EXPECT_EQ(size->height, 17U);
    EXPECT_EQ(decode_jpeg(image, kLimit).width, 33);
    for (const std::size_t length : {2U, 3U, 10U, 50000U}) EXPECT_FALSE(jpeg_size(image.substr(0, length)));
  }
}

// What a part holds is passed over, even if it looks like a frame; some parts have no length.
TEST(Jpeg, TheFirstFrameTellsTheSize) {
  using std::string_view_literals::operator""sv;
  const auto size_of = [](std::string_view parts) { return jpeg_size("\xff\xd8" + std::string(parts)); };
  constexpr std::string_view kFrame = "\xff\xc2\x00\x11\x08\x01\x02\x03\x04"sv;
  for (const std::string_view before :
       {""sv, "\xff\xfe\x00\x0b\xff\xc0\x00\x11\x08\x00\x07\x00\x09"sv,  // a comment
        "\xff\x02\x00\x0b\xff\xc0\x00\x11\x08\x00\x07\x00\x09"sv,        // the lowest kind with a length
        "\xff\x01"sv, "\xff\x00"sv, "\xff\xd0"sv, "\xff\xd9"sv,
        "\xff\xda\x00\x0b\xff\xc0\x00\x11\x08\x00\x07\x00\x09"sv,
        "\xff\xc4\x00\x09\x08\x00\x07\x00\x09\x00\x00"sv, "\xff\xc8\x00\x09\x08\x00\x07\x00\x09\x00\x00"sv,
        "\xff\xcc\x00\x09\x08\x00\x07\x00\x09\x00\x00"sv}) {
    const std::optional<ImageSize> size = size_of(std::string(before).append(kFrame));
    ASSERT_TRUE(size) << testing::PrintToString(before);
    EXPECT_EQ(size->width, 0x304U) << testing::PrintToString(before);
    EXPECT_EQ(size->height, 0x102U) << testing::PrintToString(before);
    EXPECT_FALSE(size_of(std::string(before).append(kFrame.substr(0, kFrame.size() - 1))));
  }
  for (int kind = 0xc0; kind <= 0xcf; ++kind) {
    std::string frame(kFrame);
    frame[1] = static_cast<char>(kind);
    EXPECT_EQ(size_of(frame).has_value(), kind != 0xc4 && kind != 0xc8 && kind != 0xcc) << kind;
  }
}

RC_GTEST_PROP(Jpeg, AnyBytesHaveASizeOrNone, (const std::string& bytes)) {
  const std::optional<ImageSize> size = jpeg_size("\xff\xd8\xff" + bytes);
  const bool is_plausible = !size || size->width < 65536;
  RC_ASSERT(is_plausible);
}

TEST(Jpeg, RefusesWhatIsCutShort) {
  for (const bool progressive : {false, true}) {
    const std::string whole = test::rgb_jpeg(64, 64, halves(64, 64, 3, 254, 0), progressive);
    for (std::size_t size = 3; size + 2 < whole.size(); size += 7)
      EXPECT_TRUE(contains(error_of(whole.substr(0, size)), "not a readable JPEG")) << size;
  }
}

TEST(Jpeg, RefusesSizesThatItsDataCannotFill) {
  std::string bytes = test::gray_jpeg(16, 16, halves(16, 16, 1, 0, 205));
  const std::size_t frame = bytes.find("\xff\xc0");
  ASSERT_NE(frame, std::string::npos);
  const auto with_side = [&](int side) {
    std::string changed = bytes;
    for (const std::size_t at : {frame + 5, frame + 7}) {
      changed[at] = static_cast<char>(side >> 8);
      changed[at + 1] = static_cast<char>(side);
    }
    return changed;
  };
  EXPECT_TRUE(contains(error_of(with_side(65500)), "65500 x 65500 pixels exceed the limit"));
  EXPECT_TRUE(
      contains(test::message_of<ParseError>([&] { decode_jpeg(with_side(16000), 1U << 28); }), "end early"));
  EXPECT_TRUE(contains(error_of(with_side(0)), "JPEG"));
}

TEST(Jpeg, RefusesAnEndlessRowOfScans) {
  // The last scan of a progressive file, over and over: each costs a pass over the whole image.
  const std::string whole = test::rgb_jpeg(64, 64, halves(64, 64, 3, 254, 0), true);
  const std::size_t last = whole.rfind("\xff\xda");
  ASSERT_NE(last, std::string::npos);
  std::string bytes = whole.substr(0, last);
  for (int i = 0; i < 200; ++i) bytes += whole.substr(last, whole.size() - 2 - last);
  bytes += "\xff\xd9";
  EXPECT_TRUE(contains(error_of(bytes), "not a readable JPEG"));
}

RC_GTEST_PROP(Jpeg, WhatIsChangedIsRefusedOrRead, ()) {
  static const std::string whole = test::rgb_jpeg(24, 24, halves(24, 24, 3, 254, 0), true);
  std::string bytes = whole;
  for (int i = 0; i < 4; ++i)
    bytes[*rc::gen::inRange<std::size_t>(0, bytes.size())] = *rc::gen::arbitrary<char>();
  try {
    const MapImage image = decode_jpeg(bytes, kLimit);
    RC_ASSERT(image.lightness.size() ==
              static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height));
  } catch (const ParseError&) {
  }
}

}  // namespace
}  // namespace gridmerge
