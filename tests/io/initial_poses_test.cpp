// SPDX-License-Identifier: Apache-2.0
#include "gridmerge/io/initial_poses.hpp"

#include <gtest/gtest.h>

#include <numbers>
#include <string>

namespace gridmerge {
namespace {

TEST(InitialPoses, AreReadWithTheirDeviations) {
  const auto poses = parse_initial_poses(
      "folder/poses.tsv",
      "map\tx\ty\ttheta\tsd\tsd_theta\na.yaml\t1.5\t-2\t7\t0.25\t0.125\r\n\nb.yaml\t0\t0\t0\t2\t1\n");
  ASSERT_EQ(poses.size(), 2u);
  EXPECT_EQ(poses[0].name, "a.yaml");
  EXPECT_EQ(poses[0].path, "folder/a.yaml");
  EXPECT_EQ(poses[0].T_world_map.x, 1.5);
  EXPECT_EQ(poses[0].T_world_map.y, -2.0);
  EXPECT_NEAR(poses[0].T_world_map.theta, 7.0 - 2.0 * std::numbers::pi, 1e-12);
  EXPECT_EQ(poses[0].sd_position, 0.25);
  EXPECT_EQ(poses[0].sd_theta, 0.125);
}

TEST(InitialPoses, ASpreadsheetsTableIsRead) {
  const auto poses =
      parse_initial_poses("poses.tsv", "\xEF\xBB\xBFmap\tx\ty\ttheta\na.yaml\t+0.5\t 1.0\t-2 \n");
  ASSERT_EQ(poses.size(), 1u);
  EXPECT_EQ(poses[0].T_world_map.x, 0.5);
  EXPECT_EQ(poses[0].T_world_map.y, 1.0);
  EXPECT_EQ(poses[0].T_world_map.theta, -2.0);
}

TEST(InitialPoses, HaveUsualDeviations) {
  const auto poses = parse_initial_poses("poses.tsv", "theta\ty\tx\tmap\n0\t2\t1\ta.yaml\n");
  ASSERT_EQ(poses.size(), 1u);
  EXPECT_EQ(poses[0].T_world_map.x, 1.0);
  EXPECT_EQ(poses[0].sd_position, 1.0);
  EXPECT_EQ(poses[0].sd_theta, 0.1);
}

TEST(InitialPoses, ErrorsNameFileLineAndCause) {
  const auto expect = [](const std::string& text, const std::string& where, const std::string& cause) {
    try {
      parse_initial_poses("poses.tsv", text);
      FAIL() << text;
    } catch (const FileError& error) {
      const std::string what = error.what();
      EXPECT_NE(what.find(where), std::string::npos) << what;
      EXPECT_NE(what.find(cause), std::string::npos) << what;
    }
  };
  const std::string head = "map\tx\ty\ttheta\n";
  expect("", "poses.tsv", "empty");
  expect("map\tx\ty\n", "poses.tsv:1", "theta");
  expect("map\tx\ty\ttheta\tz\n", "poses.tsv:1", "'z'");
  expect(head + "a\t0\t0\n", "poses.tsv:2", "3 fields");
  expect(head + "a\t0\t1e8\t0\n", "poses.tsv:2", "y is farther off");
  expect(head + "a\t0\tinf\t0\n", "poses.tsv:2", "finite");
  expect(head + "a\t0\t \t0\n", "poses.tsv:2", "finite");
  expect(head + "a\t0\t1 2\t0\n", "poses.tsv:2", "finite");
  expect(head + "a\t0\t0\t0\n\na\t0\t0\t0\n", "poses.tsv:4", "a second time");
  expect(head + std::string("a\0b\t0\t0\t0\n", 10), "poses.tsv:2", "NUL");
  expect("map\tx\ty\ttheta\tsd\na\t0\t0\t0\t0\n", "poses.tsv:2", "sd must be positive");
  expect("map\tx\ty\ttheta\tsd_theta\na\t0\t0\t0\t-1\n", "poses.tsv:2", "sd_theta must be positive");
}

TEST(InitialPoses, LimitsThemselvesAreFine) {
  const auto poses = parse_initial_poses(
      "poses.tsv",
      "map\tx\ty\ttheta\tsd\tsd_theta\na\t1e7\t-1e7\t0\t0.000001\t0.000001\nb\t0\t0\t0\t1e5\t1e5\n");
  ASSERT_EQ(poses.size(), 2u);
  EXPECT_EQ(poses[0].T_world_map.x, 1e7);
  EXPECT_EQ(poses[0].T_world_map.y, -1e7);
  EXPECT_EQ(poses[0].sd_position, 1e-6);
  EXPECT_EQ(poses[0].sd_theta, 1e-6);
  EXPECT_EQ(poses[1].sd_position, 1e5);
  EXPECT_EQ(poses[1].sd_theta, 1e5);
  for (const char* row : {"10000001\t0\t0\t1\t1", "0\t-10000001\t0\t1\t1", "0\t0\t0\t9e-7\t1",
                          "0\t0\t0\t1\t9e-7", "0\t0\t0\t100001\t1", "0\t0\t0\t1\t1e12"})
    EXPECT_THROW(
        parse_initial_poses("poses.tsv", std::string("map\tx\ty\ttheta\tsd\tsd_theta\na\t") + row + "\n"),
        FileError)
        << row;
}

TEST(InitialPoses, OfColumnsThatSpacesPartTheErrorSaysSo) {
  const auto error_of = [](const char* text) {
    try {
      parse_initial_poses("poses.tsv", text);
    } catch (const FileError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  const std::string hint = "tabs separate columns, not spaces";
  EXPECT_NE(error_of("map x y theta\n").find(hint), std::string::npos);
  EXPECT_EQ(error_of("map\tx\ty\n").find(hint), std::string::npos);
  EXPECT_EQ(error_of("map\n").find(hint), std::string::npos);
  EXPECT_NE(error_of("map\tx\ty\ttheta\ttheta\n").find("names the column 'theta' twice"), std::string::npos);
  EXPECT_NE(error_of("map\tx\ty\ttheta\na\t\t0\t0\n").find("x is empty"), std::string::npos);
}

TEST(InitialPoses, AMissingFileIsNamed) {
  try {
    read_initial_poses("nowhere/poses.tsv");
    FAIL();
  } catch (const FileError& error) {
    EXPECT_NE(std::string(error.what()).find("nowhere/poses.tsv"), std::string::npos);
  }
}

}  // namespace
}  // namespace gridmerge
