// SPDX-License-Identifier: Apache-2.0
#include "preselect/profiles.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "rooms.hpp"

namespace gridmerge::internal {
namespace {

using test::rooms_from;

constexpr double kQuarterTurn = std::numbers::pi / 2.0;

/// A wall that faces a side, so many steps along it from the origin of the frame.
struct Wall {
  int side;
  int at;
  std::int16_t amount;
};

/// Profiles of walls as a map of its own extent would have them.
WallProfiles drawn(const std::vector<Wall>& walls, double theta, int first, int length) {
  WallProfiles profiles;
  profiles.theta = theta;
  profiles.first = first * kProfileStep;
  for (auto& side : profiles.sides) side.assign(static_cast<std::size_t>(length), 0);
  for (const Wall& wall : walls) {
    std::int16_t& value = profiles.sides[wall.side].at(static_cast<std::size_t>(wall.at - first));
    value = static_cast<std::int16_t>(value + wall.amount);
  }
  return profiles;
}

std::int64_t squares(const WallProfiles& profiles) {
  std::int64_t sum = 0;
  for (const auto& side : profiles.sides) {
    for (const std::int16_t value : side) sum += std::int64_t{value} * value;
  }
  return sum;
}

/// The same walls, turned by quarters and then shifted along sides 0 and 1.
std::vector<Wall> moved(const std::vector<Wall>& walls, int quarters, int along, int across) {
  const int shift[4] = {along, across, -along, -across};
  std::vector<Wall> result;
  for (const Wall& wall : walls) {
    const int side = (wall.side + quarters) % 4;
    result.push_back({side, wall.at + shift[side], wall.amount});
  }
  return result;
}

RC_GTEST_PROP(Profiles, FindHowFarWallsWereMovedWhateverTheExtentsOfTheMaps, ()) {
  std::vector<Wall> walls;
  for (int side = 0; side < 4; ++side) {
    const int count = *rc::gen::inRange(2, 6);
    for (int i = 0; i < count; ++i)
      walls.push_back(
          {side, *rc::gen::inRange(-20, 21), static_cast<std::int16_t>(*rc::gen::inRange(50, 300))});
  }
  const int quarters = *rc::gen::inRange(0, 4);
  const int along = *rc::gen::inRange(-15, 16), across = *rc::gen::inRange(-15, 16);
  const double theta = 0.01 * *rc::gen::inRange(-70, 71), other = 0.01 * *rc::gen::inRange(-70, 71);
  const int first_moving = -20 - *rc::gen::inRange(0, 12), first_fixed = -35 - *rc::gen::inRange(0, 12);
  const WallProfiles moving = drawn(walls, other, first_moving, 21 - first_moving + *rc::gen::inRange(0, 7));
  const WallProfiles fixed = drawn(moved(walls, quarters, along, across), theta, first_fixed,
                                   36 - first_fixed + *rc::gen::inRange(0, 7));

  const std::vector<ProfilePose> poses = align_profiles(fixed, moving, 20);
  RC_ASSERT(!poses.empty());
  RC_ASSERT(poses.size() <= 20U);
  // No pose can be more alike than the one under which all walls lie on each other.
  RC_ASSERT(poses.front().likeness == static_cast<double>(squares(moving)));
  const double du = along * kProfileStep, dv = across * kProfileStep;
  const SE2 expected{std::cos(theta) * du - std::sin(theta) * dv, std::sin(theta) * du + std::cos(theta) * dv,
                     theta + quarters * kQuarterTurn - other};
  const bool is_found = std::any_of(poses.begin(), poses.end(), [&](const ProfilePose& pose) {
    const SE2& T = pose.T_fixed_moving;
    return pose.likeness == poses.front().likeness && std::hypot(T.x - expected.x, T.y - expected.y) < 1e-9 &&
           std::abs(normalize_angle(T.theta - expected.theta)) < 1e-9;
  });
  RC_ASSERT(is_found);
  for (std::size_t i = 1; i < poses.size(); ++i) RC_ASSERT(poses[i - 1].likeness >= poses[i].likeness);
}

TEST(Profiles, OfOneStepLieOnEachOtherInOneWay) {
  // The least that there can be: each side has one wall, and no shift but one lays any on another.
  const std::vector<Wall> walls{{0, 4, 10}, {1, 4, 20}, {2, 4, 30}, {3, 4, 40}};
  const WallProfiles profiles = drawn(walls, 0.0, 4, 1);
  const std::vector<ProfilePose> poses = align_profiles(profiles, profiles, 20);
  ASSERT_EQ(poses.size(), 4U);  // a quarter each
  EXPECT_EQ(poses.front().likeness, 10.0 * 10.0 + 20.0 * 20.0 + 30.0 * 30.0 + 40.0 * 40.0);
  EXPECT_EQ(poses.front().T_fixed_moving, SE2{});
  EXPECT_EQ(align_profiles(profiles, profiles, 1).size(), 1U);
  EXPECT_TRUE(align_profiles(profiles, profiles, 0).empty());
}

/// A room of 8 m x 5 m, turned: walls of one cell, floor inside, unknown outside.
OccupancyGrid turned_room(double theta) {
  OccupancyGrid map = make_grid(240, 240, 0.05);
  for (int row = 0; row < map.height; ++row) {
    for (int column = 0; column < map.width; ++column) {
      const double x = 0.05 * (column + 0.5) - 6.0, y = 0.05 * (row + 0.5) - 6.0;
      const double u = std::abs(std::cos(theta) * x + std::sin(theta) * y);
      const double v = std::abs(-std::sin(theta) * x + std::cos(theta) * y);
      if (u > 4.1 || v > 2.6) continue;
      map.at(column, row) = u >= 4.0 || v >= 2.5 ? Cell::occupied : Cell::free;
    }
  }
  return map;
}

TEST(Profiles, HaveTheWallsOfARoomWhereTheyAre) {
  for (const double theta : {0.0, 0.3, 0.7, -0.4}) {
    const LikelihoodField field = make_likelihood_field(turned_room(theta), 0.2);
    const WallProfiles profiles = make_profiles(field);
    const Point2 middle = inverse(field.T_map_grid) * Point2{6.0, 6.0};
    const double off = normalize_angle(4.0 * (profiles.theta - theta)) / 4.0;
    EXPECT_NEAR(off, 0.0, 0.12) << theta;  // facings are parts of a turn of 0.2 rad
    // Each side has one wall that faces it: towards the room's middle, which is 4 m or 2.5 m from it.
    std::vector<double> distances;
    for (int side = 0; side < 4; ++side) {
      const std::vector<std::int16_t>& amounts = profiles.sides[side];
      ASSERT_FALSE(amounts.empty());
      const auto most = std::max_element(amounts.begin(), amounts.end());
      const double at = profiles.first + static_cast<double>(most - amounts.begin()) * kProfileStep;
      const double angle = profiles.theta + side * kQuarterTurn;
      distances.push_back(middle.x * std::cos(angle) + middle.y * std::sin(angle) - at);
      // Where no wall is near, there is as much as usual; beside the wall there is less.
      const auto least = std::min_element(amounts.begin(), amounts.end());
      EXPECT_LT(*least, 0) << theta;
      EXPECT_GT(*most, -2 * *least) << theta;
      EXPECT_LE(std::abs(least - most), 5) << theta;
    }
    std::sort(distances.begin(), distances.end());
    EXPECT_NEAR(distances[0], 2.5, 0.25) << theta;
    EXPECT_NEAR(distances[1], 2.5, 0.25) << theta;
    EXPECT_NEAR(distances[2], 4.0, 0.25) << theta;
    EXPECT_NEAR(distances[3], 4.0, 0.25) << theta;
  }
}

TEST(Profiles, OfAPartOfAFloorProposeWhereItLies) {
  const WallProfiles whole = make_profiles(make_likelihood_field(rooms_from(0), 0.2));
  const LikelihoodField all = make_likelihood_field(rooms_from(0), 0.2);
  for (const int first : {30, 60, 100, 120}) {
    const LikelihoodField part = make_likelihood_field(rooms_from(first), 0.2);
    const SE2 expected = inverse(all.T_map_grid) * SE2{0.05 * first, 0.0, 0.0} * part.T_map_grid;
    const std::vector<ProfilePose> poses = align_profiles(whole, make_profiles(part), 20);
    ASSERT_FALSE(poses.empty());
    const bool is_proposed = std::any_of(poses.begin(), poses.begin() + 3, [&](const ProfilePose& pose) {
      const SE2& T = pose.T_fixed_moving;
      return std::hypot(T.x - expected.x, T.y - expected.y) < 0.3 && std::abs(T.theta) < 0.05;
    });
    EXPECT_TRUE(is_proposed) << first;
  }
}

TEST(Profiles, SayNothingOfWallsThatFaceAllWays) {
  OccupancyGrid round = make_grid(200, 200, 0.05);
  for (int row = 0; row < round.height; ++row) {
    for (int column = 0; column < round.width; ++column) {
      const double away = std::hypot(column - 100, row - 100);
      if (away < 92.0) round.at(column, row) = away < 90.0 ? Cell::free : Cell::occupied;
    }
  }
  const WallProfiles profiles = make_profiles(make_likelihood_field(round, 0.2));
  const WallProfiles room = make_profiles(make_likelihood_field(turned_room(0.3), 0.2));
  for (const auto& side : profiles.sides) EXPECT_TRUE(side.empty());
  EXPECT_TRUE(align_profiles(profiles, room, 20).empty());
  EXPECT_TRUE(align_profiles(room, profiles, 20).empty());
}

TEST(Profiles, SayNothingOfMapsThatAreTooLong) {
  OccupancyGrid room = turned_room(0.3);
  for (const double resolution : {1.0, 1e7, 1e9, 1e300}) {
    room.resolution = resolution;
    const WallProfiles profiles = make_profiles(make_likelihood_field(room, 4.0 * resolution));
    for (const auto& side : profiles.sides) EXPECT_TRUE(side.empty()) << resolution;
  }
}

}  // namespace
}  // namespace gridmerge::internal
