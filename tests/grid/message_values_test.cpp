// SPDX-License-Identifier: Apache-2.0
#include "gridmerge/grid/message_values.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <vector>

#include "grid/generators.hpp"

namespace gridmerge {
namespace {

TEST(MessageValues, PercentagesBecomeCellsAtTheThresholds) {
  for (int value = -128; value < 128; ++value) {
    const Cell expected = value < 0 || value > 100 ? Cell::unknown
                          : value >= 65            ? Cell::occupied
                          : value <= 19            ? Cell::free
                                                   : Cell::unknown;
    EXPECT_EQ(cell_of_percentage(value), expected) << value;
  }
  EXPECT_EQ(cell_of_percentage(0, {0.5, 0.0}), Cell::free) << "a threshold counts itself";
  EXPECT_EQ(cell_of_percentage(50, {0.5, 0.0}), Cell::occupied);
  EXPECT_EQ(cell_of_percentage(49, {0.5, 0.0}), Cell::unknown);
}

TEST(MessageValues, ProbabilitiesAreHundredths) {
  EXPECT_EQ(probability_of_percentage(0), 0.0F);
  EXPECT_EQ(probability_of_percentage(37), 0.37F);
  EXPECT_EQ(probability_of_percentage(100), 1.0F);
  EXPECT_TRUE(std::isnan(probability_of_percentage(-1)));
  EXPECT_TRUE(std::isnan(probability_of_percentage(101)));
}

TEST(MessageValues, AGridOfThreeValuesHasNoProbabilities) {
  const std::vector<std::int8_t> plain{-1, 0, 100, 0, -1, 100}, shaded{-1, 0, 100, 50, -1, 100};
  EXPECT_TRUE(grid_of_percentages(3, 2, 0.1, {}, plain).probability.empty());
  EXPECT_EQ(grid_of_percentages(3, 2, 0.1, {}, shaded).probability[3], 0.5F);
  const std::vector<std::int8_t> strange{-1, 0, 100, 101, -2, 100};
  const OccupancyGrid grid = grid_of_percentages(3, 2, 0.1, {}, strange);
  EXPECT_TRUE(grid.probability.empty()) << "what is no percentage is unknown, as -1 is";
  EXPECT_EQ(grid.cells[3], Cell::unknown);
  EXPECT_EQ(grid.cells[4], Cell::unknown);
}

RC_GTEST_PROP(MessageValues, AGridHasEveryValueInItsPlace, ()) {
  const int width = *rc::gen::inRange(1, 20), height = *rc::gen::inRange(1, 20);
  const auto values = *rc::gen::container<std::vector<std::int8_t>>(static_cast<std::size_t>(width * height),
                                                                    rc::gen::arbitrary<std::int8_t>());
  const SE2 origin = *any_pose();
  const OccupancyGrid grid = grid_of_percentages(width, height, 0.05, origin, values);
  RC_ASSERT(grid.origin == origin);
  RC_ASSERT(grid.width == width && grid.height == height && grid.resolution == 0.05);
  for (std::size_t i = 0; i < values.size(); ++i) {
    RC_ASSERT(grid.cells[i] == cell_of_percentage(values[i]));
    if (grid.probability.empty()) {
      RC_ASSERT(values[i] <= 0 || values[i] >= 100);
      continue;
    }
    const float expected = probability_of_percentage(values[i]);
    RC_ASSERT(grid.probability[i] == expected || (std::isnan(grid.probability[i]) && std::isnan(expected)));
  }
}

TEST(MessageValues, AGridOfTheWrongSizeIsRefused) {
  const std::vector<std::int8_t> values(5);
  EXPECT_THROW(grid_of_percentages(3, 2, 0.1, {}, values), std::invalid_argument);
  EXPECT_THROW(grid_of_percentages(0, 2, 0.1, {}, {}), std::invalid_argument);
  EXPECT_THROW(grid_of_percentages(5, 1, 0.0, {}, values), std::invalid_argument);
}

TEST(MessageValues, AFloatIsTheDecimalItWasMadeFrom) {
  EXPECT_EQ(decimal_of(0.05F), 0.05);
  EXPECT_EQ(decimal_of(0.1F), 0.1);
  EXPECT_EQ(decimal_of(1e-6F), 1e-6);
  EXPECT_TRUE(std::isnan(decimal_of(std::numeric_limits<float>::quiet_NaN())));
  EXPECT_EQ(decimal_of(-std::numeric_limits<float>::infinity()), -std::numeric_limits<double>::infinity());
}

RC_GTEST_PROP(MessageValues, ADecimalIsTheFloatAgain, (float value)) {
  RC_ASSERT(static_cast<float>(decimal_of(value)) == value);
}

RC_GTEST_PROP(MessageValues, AQuaternionIsItsYaw, ()) {
  const double theta = *between(-3.14, 3.14);
  const double sign = *rc::gen::element(1.0, -1.0);  // both stand for one rotation
  const Yaw yaw = yaw_of({0.0, 0.0, sign * std::sin(theta / 2), sign * std::cos(theta / 2)});
  RC_ASSERT(yaw.kind == Rotation::about_z);
  RC_ASSERT(std::abs(normalize_angle(yaw.theta - theta)) < 1e-12);
}

TEST(MessageValues, QuaternionsThatAreNoTurnAreTold) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(yaw_of({0, 0, 0, 0}).kind, Rotation::missing);
  EXPECT_EQ(yaw_of({0, 0, 0, 0.5}).kind, Rotation::not_unit);
  EXPECT_EQ(yaw_of({0, 0, nan, 1}).kind, Rotation::not_unit);
  EXPECT_EQ(yaw_of({1e200, 0, 0, 1e200}).kind, Rotation::not_unit);
  EXPECT_EQ(yaw_of({std::sqrt(0.5), 0, 0, std::sqrt(0.5)}).kind, Rotation::tilted);
  EXPECT_EQ(yaw_of({1, 0, 0, 0}).kind, Rotation::tilted) << "upside down";
  EXPECT_EQ(yaw_of({0.0002, 0.0002, 0, 1}).kind, Rotation::about_z) << "what floats leave of a flat pose";
}

TEST(MessageValues, QuaternionsMayBeALittleOff) {
  // Their length by a thousandth.
  for (const double length : {0.9991, 1.0009}) EXPECT_EQ(yaw_of({0, 0, 0, length}).kind, Rotation::about_z);
  for (const double length : {0.9989, 1.0011}) EXPECT_EQ(yaw_of({0, 0, 0, length}).kind, Rotation::not_unit);
  // Their axis by a twentieth of a degree, whichever way, and whichever way the map is turned.
  const auto tilted = [](double degrees, bool about_y) {
    const double half = 0.5 * degrees * std::numbers::pi / 180.0, s = std::sin(half), c = std::cos(half);
    const double yaw = 0.7;  // half of it
    return about_y ? yaw_of({-s * std::sin(yaw), s * std::cos(yaw), c * std::sin(yaw), c * std::cos(yaw)})
                   : yaw_of({s * std::cos(yaw), s * std::sin(yaw), c * std::sin(yaw), c * std::cos(yaw)});
  };
  for (const bool about_y : {false, true}) {
    EXPECT_EQ(tilted(0.050, about_y).kind, Rotation::about_z);
    EXPECT_EQ(tilted(0.053, about_y).kind, Rotation::tilted);
    EXPECT_NEAR(tilted(0.050, about_y).theta, 1.4, 1e-6);
  }
}

}  // namespace
}  // namespace gridmerge
