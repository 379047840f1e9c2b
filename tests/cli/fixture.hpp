// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <set>
#include <string>

#include "program.hpp"
#include "support/building.hpp"

namespace gridmerge::test {

using Json = nlohmann::json;

/// Maps for the program to work on: two robots in one building, "left" and "right", and one elsewhere,
/// "other".
class CliTest : public testing::Test {
 protected:
  CliTest()
      : left(write_map(directory, "left", map_part(draw_building(1), {0, 0, 13, 13}, T_left_building))),
        right(write_map(directory, "right", map_part(draw_building(1), {5, 0, 18, 13}, T_right_building))),
        other(write_map(directory, "other", draw_building(2))) {}

  const SE2 T_left_building{-3.0, 2.0, 0.4};
  const SE2 T_right_building{1.0, -7.0, -1.1};
  const SE2 T_left_right = T_left_building * inverse(T_right_building);

  const TemporaryDirectory directory;
  const std::string left;
  const std::string right;
  const std::string other;
};

/// Exit code 1, and stderr is one line that names the program and holds both texts.
inline void expect_error(const Outcome& outcome, const std::string& file, const std::string& cause) {
  EXPECT_EQ(outcome.exit_code, 1) << outcome.err;
  EXPECT_EQ(outcome.out, "");
  EXPECT_EQ(count_lines(outcome.err), 1u) << outcome.err;
  EXPECT_EQ(outcome.err.find("gridmerge: "), 0u) << outcome.err;
  EXPECT_NE(outcome.err.find(file), std::string::npos) << outcome.err << "does not name " << file;
  EXPECT_NE(outcome.err.find(cause), std::string::npos) << outcome.err << "does not say " << cause;
}

inline void expect_keys(const Json& object, const std::set<std::string>& keys) {
  std::set<std::string> present;
  for (const auto& [key, value] : object.items()) present.insert(key);
  EXPECT_EQ(present, keys);
}

inline void expect_near(const Json& transform, const SE2& expected, double metres, double radians) {
  expect_keys(transform, {"x", "y", "theta"});
  EXPECT_NEAR(transform.at("x"), expected.x, metres);
  EXPECT_NEAR(transform.at("y"), expected.y, metres);
  EXPECT_NEAR(normalize_angle(transform.at("theta").get<double>() - expected.theta), 0.0, radians);
}

}  // namespace gridmerge::test
