// SPDX-License-Identifier: Apache-2.0
// Single messages in CDR: what is written is read, and what is no map is refused.
#include "bag/map_messages.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "bag/bag_builder.hpp"
#include "gridmerge/io/map_file.hpp"
#include "io/map_yaml.hpp"
#include "io/parse_error.hpp"
#include "io/support.hpp"

namespace gridmerge {
namespace {

using namespace internal;
using test::CdrKind;
using test::contains;
using test::map_message;
using test::MapFields;
using test::update_message;
using test::UpdateFields;

constexpr std::size_t kMaxCells = 1000;

rc::Gen<CdrKind> any_kind() {
  return rc::gen::element(CdrKind::big, CdrKind::little, CdrKind::big2, CdrKind::little2);
}

rc::Gen<MapFields> any_map() {
  return rc::gen::exec([] {
    MapFields map;
    map.frame_id = *rc::gen::container<std::string>(rc::gen::inRange('a', 'z'));
    map.resolution = static_cast<float>(*rc::gen::inRange(1, 1000)) / 1000.0F;
    map.width = *rc::gen::inRange<std::uint32_t>(1, 20);
    map.height = *rc::gen::inRange<std::uint32_t>(1, 20);
    map.x = *rc::gen::inRange(-1000, 1000) / 7.0;
    map.y = *rc::gen::inRange(-1000, 1000) / 7.0;
    const double theta = *rc::gen::inRange(-314, 314) / 100.0;
    map.qz = std::sin(theta / 2);
    map.qw = std::cos(theta / 2);
    map.values = *rc::gen::container<std::vector<std::int8_t>>(map.width * map.height,
                                                               rc::gen::inRange<std::int8_t>(-1, 101));
    return map;
  });
}

std::string error_of(const std::string& message, std::size_t max_cells = kMaxCells) {
  return test::message_of<ParseError>([&] { parse_map_message(message, max_cells); });
}

RC_GTEST_PROP(MapMessages, WhatIsWrittenIsRead, ()) {
  const MapFields fields = *any_map();
  const MapMessage map = parse_map_message(map_message(fields, *any_kind()), kMaxCells);
  RC_ASSERT(map.frame_id == fields.frame_id);
  RC_ASSERT(static_cast<float>(map.resolution) == fields.resolution);
  RC_ASSERT(map.width == static_cast<int>(fields.width) && map.height == static_cast<int>(fields.height));
  RC_ASSERT(map.origin.x == fields.x && map.origin.y == fields.y);
  RC_ASSERT(std::abs(std::sin(map.origin.theta / 2) * fields.qw -
                     std::cos(map.origin.theta / 2) * fields.qz) < 1e-12);
  RC_ASSERT(map.values == fields.values);
}

RC_GTEST_PROP(MapMessages, AMessageCutShortIsRefused, ()) {
  const std::string message = map_message(*any_map(), *any_kind());
  const auto length = *rc::gen::inRange<std::size_t>(0, message.size());
  RC_ASSERT_THROWS_AS(parse_map_message(message.substr(0, length), kMaxCells), ParseError);
}

RC_GTEST_PROP(MapMessages, RandomBytesAreNoMapOrASoundOne, ()) {
  std::string message = map_message(*any_map(), *any_kind());
  for (int changes = *rc::gen::inRange(1, 5); changes > 0; --changes)
    message[*rc::gen::inRange<std::size_t>(0, std::min<std::size_t>(message.size(), 120))] =
        *rc::gen::arbitrary<char>();
  try {
    const MapMessage map = parse_map_message(message, kMaxCells);
    RC_ASSERT(map.values.size() ==
              static_cast<std::size_t>(map.width) * static_cast<std::size_t>(map.height));
    RC_ASSERT(map.values.size() <= kMaxCells);
    RC_ASSERT(map.is_empty() || (std::isfinite(map.origin.theta) && map.resolution > 0.0));
  } catch (const ParseError&) {
  }
}

TEST(MapMessages, ResolutionsAreDecimals) {
  EXPECT_EQ(parse_map_message(map_message({.resolution = 0.05F}), kMaxCells).resolution, 0.05);
}

TEST(MapMessages, PlacesThatNoMapHasAreRefused) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(contains(error_of(map_message({.resolution = 0.0F})), "resolution"));
  EXPECT_TRUE(contains(error_of(map_message({.resolution = -0.05F})), "resolution"));
  EXPECT_TRUE(
      contains(error_of(map_message({.resolution = std::numeric_limits<float>::quiet_NaN()})), "resolution"));
  EXPECT_TRUE(contains(error_of(map_message({.x = nan})), "origin"));
  EXPECT_TRUE(contains(error_of(map_message({.y = 2e9})), "origin"));
  EXPECT_TRUE(contains(error_of(map_message({.qx = std::sqrt(0.5), .qw = std::sqrt(0.5)})), "tilted"));
  EXPECT_EQ(error_of(map_message({.qx = 0.125, .qy = 0.25, .qz = 0.5, .qw = 0.375})),
            "the map's orientation (0.125, 0.25, 0.5, 0.375) is no quaternion of length 1");
  EXPECT_TRUE(contains(error_of(map_message({.qz = nan})), "no quaternion of length 1"));
}

TEST(MapMessages, SizesAreCheckedBeforeMemoryIsTaken) {
  EXPECT_TRUE(contains(error_of(map_message({.width = 4'000'000'000U, .height = 4'000'000'000U})),
                       "4000000000 x 4000000000 cells exceed the limit"));
  EXPECT_TRUE(contains(error_of(map_message(), 5), "3 x 2 cells exceed the limit of 5"));
  EXPECT_TRUE(contains(error_of(map_message({.values = {0, 0, 0}})), "3 values for 3 x 2 cells"));
  std::string claims = map_message();
  claims.replace(claims.size() - 6 - 4, 4, "\xff\xff\xff\xff");  // as the number of values
  EXPECT_TRUE(contains(error_of(claims), "ends early"));
}

// The longest side that fits an int is let pass here, and its cells are missed then.
TEST(MapMessages, ASideFitsAnInt) {
  constexpr std::size_t kAny = std::numeric_limits<std::size_t>::max();
  const auto error = [&](std::uint32_t width, std::uint32_t height) {
    return error_of(map_message({.width = width, .height = height, .values = {0}}), kAny);
  };
  constexpr std::uint32_t kMost = 2'147'483'647;
  EXPECT_EQ(error(kMost, 1), "the message has 1 values for 2147483647 x 1 cells");
  EXPECT_EQ(error(1, kMost), "the message has 1 values for 1 x 2147483647 cells");
  EXPECT_EQ(error(kMost, kMost), "the message has 1 values for 2147483647 x 2147483647 cells");
  EXPECT_EQ(error(kMost + 1, 1), "2147483648 x 1 cells exceed the limit of 18446744073709551615");
  EXPECT_EQ(error(1, kMost + 1), "1 x 2147483648 cells exceed the limit of 18446744073709551615");
}

TEST(MapMessages, ExactlySoManyCellsAreRead) {
  EXPECT_EQ(parse_map_message(map_message(), 6).values, (std::vector<std::int8_t>{-1, 0, 100, 0, 0, 100}));
  EXPECT_EQ(error_of(map_message(), 5), "3 x 2 cells exceed the limit of 5");
  EXPECT_EQ(error_of(map_message({.values = {0, 0, 0, 0, 0}}), 6),
            "the message has 5 values for 3 x 2 cells");
  EXPECT_EQ(error_of(map_message({.values = {0, 0, 0, 0, 0, 0, 0}}), 6),
            "the message has 7 values for 3 x 2 cells");
}

TEST(MapMessages, AnOriginLiesWithinTheLimitToTheLastDigit) {
  for (const double sign : {1.0, -1.0}) {
    const double most = sign * kMaxOrigin, beyond = sign * std::nextafter(kMaxOrigin, 2 * kMaxOrigin);
    const MapMessage map = parse_map_message(map_message({.x = most, .y = -most}), kMaxCells);
    EXPECT_EQ(map.origin.x, most);
    EXPECT_EQ(map.origin.y, -most);
    EXPECT_TRUE(contains(error_of(map_message({.x = beyond})), "the map's origin is "));
    EXPECT_TRUE(contains(error_of(map_message({.y = beyond})), "the map's origin is "));
    EXPECT_TRUE(contains(error_of(map_message({.x = sign * std::numeric_limits<double>::infinity()})),
                         "the map's origin is "));
  }
  EXPECT_EQ(parse_map_message(map_message({.z = 2 * kMaxOrigin}), kMaxCells).values.size(), 6u)
      << "its height does not matter";
}

TEST(MapMessages, TypesHaveANameOfRos2AndOneOfRos1) {
  EXPECT_TRUE(is_map_type("nav_msgs/msg/OccupancyGrid"));
  EXPECT_TRUE(is_map_type("nav_msgs/OccupancyGrid"));
  EXPECT_TRUE(is_update_type("map_msgs/msg/OccupancyGridUpdate"));
  EXPECT_TRUE(is_update_type("map_msgs/OccupancyGridUpdate"));
  for (const char* other : {"", "OccupancyGrid", "nav_msgs/msg/OccupancyGridUpdate", "nav_msgs/msg/Path"}) {
    EXPECT_FALSE(is_map_type(other)) << other;
    EXPECT_FALSE(is_update_type(other)) << other;
  }
  EXPECT_FALSE(is_map_type("map_msgs/msg/OccupancyGridUpdate"));
  EXPECT_FALSE(is_update_type("nav_msgs/msg/OccupancyGrid"));
}

TEST(MapMessages, AnOrientationOfZerosIsNone) {
  const MapMessage map = parse_map_message(map_message({.qw = 0.0}), kMaxCells);
  EXPECT_TRUE(map.lacks_rotation);
  EXPECT_EQ(map.origin.theta, 0.0);
  EXPECT_FALSE(parse_map_message(map_message(), kMaxCells).lacks_rotation);
}

TEST(MapMessages, AMapWithoutCellsIsNoError) {
  EXPECT_TRUE(
      parse_map_message(map_message({.resolution = 0.0F, .width = 0, .height = 0, .values = {}}), kMaxCells)
          .is_empty());
  for (const auto& [width, height] : {std::pair(0U, 5U), std::pair(5U, 0U), std::pair(0U, 4'000'000'000U)}) {
    const MapMessage map =
        parse_map_message(map_message({.width = width, .height = height, .values = {}}), kMaxCells);
    EXPECT_TRUE(map.is_empty());
    EXPECT_EQ(map.frame_id, "map");
    EXPECT_EQ(map.width, 0);
  }
  EXPECT_FALSE(parse_map_message(map_message({.width = 1, .height = 1, .values = {0}}), 1).is_empty());
}

TEST(MapMessages, OtherEncodingsAreRefused) {
  std::string message = map_message();
  message[1] = 3;  // parameter list
  EXPECT_TRUE(contains(error_of(message), "not in plain CDR (its kind is 3)"));
  EXPECT_TRUE(contains(error_of(""), "ends early"));
}

RC_GTEST_PROP(MapMessages, UpdatesThatAreWrittenAreRead, ()) {
  UpdateFields fields;
  fields.x = *rc::gen::inRange(-5, 5);
  fields.y = *rc::gen::inRange(-5, 5);
  fields.width = *rc::gen::inRange<std::uint32_t>(0, 9);
  fields.height = *rc::gen::inRange<std::uint32_t>(0, 9);
  fields.values = *rc::gen::container<std::vector<std::int8_t>>(fields.width * fields.height,
                                                                rc::gen::arbitrary<std::int8_t>());
  const std::string message = update_message(fields, *any_kind());
  const MapUpdate update = parse_map_update(message);
  RC_ASSERT(update.x == fields.x && update.y == fields.y);
  RC_ASSERT(update.width == fields.width && update.height == fields.height);
  RC_ASSERT(std::equal(fields.values.begin(), fields.values.end(), update.values.begin(), update.values.end(),
                       [](std::int8_t a, char b) { return a == static_cast<std::int8_t>(b); }));
  const auto length = *rc::gen::inRange<std::size_t>(0, message.size());
  RC_ASSERT_THROWS_AS(parse_map_update(message.substr(0, length)), ParseError);
}

TEST(MapMessages, UpdatesOfTheWrongSizeAreRefused) {
  const std::string message = update_message({.width = 2, .height = 2, .values = {0, 0, 0}});
  EXPECT_TRUE(
      contains(test::message_of<ParseError>([&] { parse_map_update(message); }), "3 values for 2 x 2 cells"));
}

}  // namespace
}  // namespace gridmerge
