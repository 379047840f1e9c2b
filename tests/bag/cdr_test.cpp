// SPDX-License-Identifier: Apache-2.0
// Values in CDR, byte by byte.
#include "bag/cdr.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <string>

#include "io/parse_error.hpp"
#include "io/support.hpp"

namespace gridmerge {
namespace {

using namespace internal;

constexpr const char* kEndsEarly = "the message ends early";

std::string message_of_bytes(std::initializer_list<int> bytes) {
  std::string message;
  for (const int byte : bytes) message += static_cast<char>(byte);
  return message;
}

template <typename Call>
std::string error_of(const Call& call) {
  return test::message_of<ParseError>(call);
}

TEST(Cdr, TwoBytesTellTheKind) {
  const auto error = [](int first, int second) {
    return error_of([&] { CdrReader(message_of_bytes({first, second, 0, 0})); });
  };
  const auto refusal = [](int kind) {
    return "the message is not in plain CDR (its kind is " + std::to_string(kind) + ")";
  };
  for (const int kind : {2, 3, 4, 5, 8, 9, 10, 255}) EXPECT_EQ(error(0, kind), refusal(kind));
  EXPECT_EQ(error(1, 0), refusal(256));
  EXPECT_EQ(error(1, 1), refusal(257));
  EXPECT_EQ(error(2, 7), refusal(519));
  EXPECT_EQ(error(255, 254), refusal(65'534));
  for (const int kind : {0, 1, 6, 7}) {
    const std::string message = message_of_bytes({0, kind, 0xAA, 0xBB});
    EXPECT_NO_THROW(CdrReader{message}) << kind;
    EXPECT_EQ(error_of([&] { CdrReader(message).read_int32(); }), kEndsEarly);
    EXPECT_EQ(error_of([&] { CdrReader(std::string_view(message).substr(0, 3)); }), kEndsEarly);
  }
  EXPECT_EQ(error_of([] { CdrReader(""); }), kEndsEarly);
}

TEST(Cdr, NumbersAreReadInTheirByteOrder) {
  for (const int kind : {0, 6}) {
    const std::string message =
        message_of_bytes({0, kind, 0, 0, 0x01, 0x82, 0x03, 0x84, 0xFF, 0xFF, 0xFF, 0xFE, 0x3F, 0xC0, 0, 0});
    CdrReader reader(message);
    EXPECT_EQ(reader.read_uint32(), 0x01820384U);
    EXPECT_EQ(reader.read_int32(), -2);
    EXPECT_EQ(reader.read_float(), 1.5F);
    EXPECT_EQ(error_of([&] { reader.read_float(); }), kEndsEarly);
  }
  for (const int kind : {1, 7}) {
    const std::string message =
        message_of_bytes({0, kind, 0, 0, 0x84, 0x03, 0x82, 0x01, 0xFE, 0xFF, 0xFF, 0xFF, 0, 0, 0xC0, 0x3F});
    CdrReader reader(message);
    EXPECT_EQ(reader.read_uint32(), 0x01820384U);
    EXPECT_EQ(reader.read_int32(), -2);
    EXPECT_EQ(reader.read_float(), 1.5F);
    EXPECT_EQ(error_of([&] { reader.read_uint32(); }), kEndsEarly);
  }
  const std::string extremes = message_of_bytes({0, 1, 0, 0, 0, 0, 0, 0x80, 0xFF, 0xFF, 0xFF, 0x7F});
  CdrReader limits(extremes);
  EXPECT_EQ(limits.read_int32(), std::numeric_limits<std::int32_t>::min());
  EXPECT_EQ(limits.read_int32(), std::numeric_limits<std::int32_t>::max());
}

// -2.5 is C004000000000000.
TEST(Cdr, DoublesStandAtAMultipleOfEightInVersionOneAndOfFourInVersionTwo) {
  const std::string big = message_of_bytes({0xC0, 0x04, 0, 0, 0, 0, 0, 0});
  const std::string little(big.rbegin(), big.rend());
  const std::string one = message_of_bytes({1, 1, 1, 1}), gap = message_of_bytes({9, 9, 9, 9});
  const auto read = [&](int kind, const std::string& body) {
    const std::string message = message_of_bytes({0, kind, 0, 0}) + body;
    CdrReader reader(message);
    EXPECT_EQ(reader.read_uint32(), 0x01010101U);
    EXPECT_EQ(reader.read_double(), -2.5) << kind;
    EXPECT_EQ(reader.read_uint32(), 0x01010101U) << "right behind it";
    CdrReader cut(std::string_view(message).substr(0, message.size() - 5));
    cut.read_uint32();
    EXPECT_EQ(error_of([&] { cut.read_double(); }), kEndsEarly) << kind;
  };
  read(0, one + gap + big + one);
  read(1, one + gap + little + one);
  read(6, one + big + one);
  read(7, one + little + one);
}

TEST(Cdr, NumbersBehindBytesStandAtAMultipleOfFour) {
  for (int count = 0; count <= 8; ++count) {
    std::string message =
        message_of_bytes({0, 1, 0, 0, count, 0, 0, 0}) + std::string(static_cast<std::size_t>(count), 'x');
    const std::string bytes_only = message;
    while (message.size() % 4 != 0) message += '?';
    message += message_of_bytes({7, 0, 0, 0});
    CdrReader reader(message);
    EXPECT_EQ(reader.read_bytes(), std::string(static_cast<std::size_t>(count), 'x'));
    EXPECT_EQ(reader.read_uint32(), 7u) << count;
    EXPECT_EQ(error_of([&] { reader.read_bytes(); }), kEndsEarly);
    CdrReader end(bytes_only);
    EXPECT_EQ(end.read_bytes(), std::string(static_cast<std::size_t>(count), 'x')) << "to the last byte";
    EXPECT_EQ(error_of([&] { end.read_uint32(); }), kEndsEarly) << count;
    CdrReader cut(std::string_view(message).substr(0, message.size() - 1));
    cut.read_bytes();
    EXPECT_EQ(error_of([&] { cut.read_uint32(); }), kEndsEarly) << count;
  }
}

TEST(Cdr, ACountBeyondTheMessageIsRefused) {
  for (const int count : {4, 5, 255}) {
    const std::string message = message_of_bytes({0, 1, 0, 0, count, 0, 0, 0, 'a', 'b', 'c'});
    EXPECT_EQ(error_of([&] { CdrReader(message).read_bytes(); }), kEndsEarly);
    EXPECT_EQ(error_of([&] { CdrReader(message).read_string(); }), kEndsEarly);
  }
  const std::string huge = message_of_bytes({0, 1, 0, 0, 0xFF, 0xFF, 0xFF, 0xFF, 'a'});
  EXPECT_EQ(error_of([&] { CdrReader(huge).read_bytes(); }), kEndsEarly);
}

TEST(Cdr, ATextLosesOneZeroAtItsEnd) {
  const auto read = [](const std::string& text) {
    return CdrReader(message_of_bytes({0, 1, 0, 0, static_cast<int>(text.size()), 0, 0, 0}) + text)
        .read_string();
  };
  EXPECT_EQ(read(std::string("map\0", 4)), "map");
  EXPECT_EQ(read("map"), "map") << "old writers leave it out";
  EXPECT_EQ(read(std::string("m\0\0", 3)), std::string("m\0", 2));
  EXPECT_EQ(read(std::string("\0", 1)), "");
  EXPECT_EQ(read(""), "");
}

}  // namespace
}  // namespace gridmerge
