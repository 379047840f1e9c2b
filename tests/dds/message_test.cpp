// SPDX-License-Identifier: Apache-2.0
#include "dds/message.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

namespace gridmerge::internal {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// A message that may be used, to be spoiled in one place.
class MessageTest : public testing::Test {
 protected:
  MessageTest() {
    message.stamp = {12, 34};
    message.frame = "tb1/map";
    message.resolution = 0.05F;
    message.width = 3;
    message.height = 2;
    message.position = {1.0, -2.0, 0.5};
    message.data = values;
  }

  std::string refusal() const {
    try {
      read_map(message);
    } catch (const RefusedMessage& error) {
      return error.what();
    }
    return "taken";
  }

  std::vector<std::int8_t> values{-1, 0, 100, 0, -1, 0};
  MapSample message;
};

TEST_F(MessageTest, BecomesAMap) {
  const HeardMap heard = read_map(message);
  EXPECT_EQ(heard.frame, "tb1/map");
  EXPECT_EQ(heard.stamp, (Stamp{12, 34}));
  EXPECT_EQ(heard.grid.width, 3);
  EXPECT_EQ(heard.grid.height, 2);
  EXPECT_EQ(heard.grid.resolution, 0.05);  // not 0.0500000007, which the message's number is
  EXPECT_EQ(heard.grid.origin, (SE2{1.0, -2.0, 0.0}));
  EXPECT_EQ(heard.grid.cells, (std::vector<Cell>{Cell::unknown, Cell::free, Cell::occupied, Cell::free,
                                                 Cell::unknown, Cell::free}));
  EXPECT_TRUE(heard.grid.probability.empty());
  EXPECT_EQ(message_values(heard.grid), values);
  validate(heard.grid);
}

TEST_F(MessageTest, HasATime) {
  message.stamp = {0, 999'999'999};
  EXPECT_EQ(refusal(), "taken");
  message.stamp = {0, 1'000'000'000};
  EXPECT_EQ(refusal(), "a time with 1000000000 ns");
  UpdateSample update;
  update.stamp = message.stamp;
  update.frame = message.frame;
  update.width = update.height = 1;
  update.data = std::span(values).first(1);
  EXPECT_THROW(read_update(update), RefusedMessage);
}

TEST_F(MessageTest, KeepsProbabilities) {
  values[1] = 19;
  values[2] = 65;
  values[3] = 20;
  const OccupancyGrid grid = read_map(message).grid;
  EXPECT_EQ(grid.at(1, 0), Cell::free);
  EXPECT_EQ(grid.at(2, 0), Cell::occupied);
  EXPECT_EQ(grid.at(0, 1), Cell::unknown);
  ASSERT_EQ(grid.probability.size(), 6u);
  EXPECT_TRUE(std::isnan(grid.probability[0]));
  EXPECT_FLOAT_EQ(grid.probability[2], 0.65F);
}

TEST_F(MessageTest, TakesTheYawOfAnOrigin) {
  message.orientation = {0.0, 0.0, std::sin(0.35), std::cos(0.35)};
  EXPECT_NEAR(read_map(message).grid.origin.theta, 0.7, 1e-12);
  for (double& part : message.orientation) part = -part;  // the same turn
  EXPECT_NEAR(read_map(message).grid.origin.theta, 0.7, 1e-12);
  message.orientation = {};  // as in bags, none
  EXPECT_EQ(read_map(message).grid.origin.theta, 0.0);
}

TEST_F(MessageTest, IsRefusedForWrongLengths) {
  message.data = std::span(values).first(5);
  EXPECT_EQ(refusal(), "5 values for 3 x 2 cells");
  message.data = {};
  EXPECT_EQ(refusal(), "0 values for 3 x 2 cells");
}

TEST_F(MessageTest, IsRefusedForSizes) {
  message.width = 0;
  EXPECT_EQ(refusal(), "a size of 0 x 2 cells");
  message.width = 1U << 31;
  message.height = 2;  // the product is 0 in 32 bits
  EXPECT_EQ(refusal(), "2147483648 x 2 cells are above 2^28");
  message.width = message.height = 0xFFFFFFFFU;
  EXPECT_NE(refusal().find("above 2^28"), std::string::npos);
  message.width = (1U << 28) + 1;
  message.height = 1;
  EXPECT_NE(refusal().find("above 2^28"), std::string::npos);
  message.width = 1U << 28;
  EXPECT_NE(refusal().find("6 values"), std::string::npos);  // as large as may be, but without the data
}

TEST_F(MessageTest, IsRefusedForResolutions) {
  for (const float resolution : {0.0F, -0.05F, 1e-9F, 1e9F, std::numeric_limits<float>::quiet_NaN(),
                                 std::numeric_limits<float>::infinity()}) {
    message.resolution = resolution;
    EXPECT_NE(refusal().find("a resolution of"), std::string::npos) << resolution;
  }
}

TEST_F(MessageTest, IsRefusedForOrigins) {
  for (const double coordinate : {kNaN, kInfinity, -kInfinity, 1e8}) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (axis == 2 && coordinate == 1e8) continue;
      message.position = {1.0, 2.0, 3.0};
      message.position[axis] = coordinate;
      EXPECT_NE(refusal().find("an origin at"), std::string::npos) << coordinate << " in " << axis;
    }
  }
}

TEST_F(MessageTest, IsRefusedForOrientations) {
  message.orientation = {0.0, 0.0, 0.0, 1.01};
  EXPECT_EQ(refusal(), "an orientation that is no unit quaternion");
  message.orientation = {0.0, 0.0, kNaN, 1.0};
  EXPECT_EQ(refusal(), "an orientation that is no unit quaternion");
  message.orientation = {0.0, 0.0, 0.0, 1e200};
  EXPECT_EQ(refusal(), "an orientation that is no unit quaternion");
  for (const double tilt : {1.0, 0.002}) {  // [rad]
    message.orientation = {std::sin(tilt / 2), 0.0, 0.0, std::cos(tilt / 2)};
    EXPECT_EQ(refusal(), "an origin that is not level") << tilt;
  }
}

TEST_F(MessageTest, IsRefusedForCells) {
  for (const int value : {101, 127, -2, -128}) {
    values[4] = static_cast<std::int8_t>(value);
    EXPECT_NE(refusal().find("the cell value " + std::to_string(value)), std::string::npos);
  }
}

TEST_F(MessageTest, IsRefusedForFrames) {
  const std::string longest(kLongestFrame, 'a');
  const std::string longer = longest + "a";
  message.frame = longest;
  EXPECT_EQ(refusal(), "taken");
  for (const std::string_view frame :
       {std::string_view(""), std::string_view("/"), std::string_view("//a"), std::string_view("a b"),
        std::string_view("a\nb"), std::string_view("\x1b[31m"), std::string_view("k\xc3\xbc"),
        std::string_view("a\0b", 3), std::string_view(longer)}) {
    message.frame = frame;
    EXPECT_NE(refusal().find("frame_id"), std::string::npos) << frame;
  }
  message.frame = "/tb1/map";  // as TF once had it
  EXPECT_EQ(read_map(message).frame, "tb1/map");
}

TEST(UpdateSample, BecomesAPart) {
  const std::vector<std::int8_t> values{0, 100};
  UpdateSample message;
  message.frame = "map";
  message.x = 5;
  message.y = 7;
  message.width = 1;
  message.height = 2;
  message.data = values;
  const HeardPart part = read_update(message);
  EXPECT_EQ(part.x, 5);
  EXPECT_EQ(part.y, 7);
  EXPECT_EQ(part.grid.at(0, 1), Cell::occupied);
  message.y = -1;
  EXPECT_THROW(read_update(message), RefusedMessage);
  message.y = 7;
  message.height = 3;
  EXPECT_THROW(read_update(message), RefusedMessage);
}

/// Whatever a message holds, it is refused or becomes a valid map.
RC_GTEST_PROP(Messages, AreRefusedOrValid, ()) {
  const auto values = *rc::gen::container<std::vector<std::int8_t>>(rc::gen::inRange<std::int8_t>(-2, 102));
  const std::string frame = *rc::gen::string<std::string>();
  const auto number =
      rc::gen::oneOf(rc::gen::arbitrary<double>(), rc::gen::element(0.0, 1.0, kNaN, kInfinity));
  MapSample message;
  message.frame = frame;
  message.resolution = static_cast<float>(*number);
  message.width = *rc::gen::oneOf(rc::gen::inRange<std::uint32_t>(0, 5), rc::gen::arbitrary<std::uint32_t>());
  const bool fits = message.width > 0 && *rc::gen::arbitrary<bool>();
  message.height =
      fits ? static_cast<std::uint32_t>(values.size() / message.width) : *rc::gen::arbitrary<std::uint32_t>();
  for (double& part : message.position) part = *number;
  if (*rc::gen::arbitrary<bool>())
    for (double& part : message.orientation) part = *number;
  message.data = values;
  try {
    const HeardMap heard = read_map(message);
    validate(heard.grid);
    RC_ASSERT(heard.grid.cells.size() == values.size());
    RC_ASSERT(!heard.frame.empty());
  } catch (const RefusedMessage&) {
  }
}

}  // namespace
}  // namespace gridmerge::internal
