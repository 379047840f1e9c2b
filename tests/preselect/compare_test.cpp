// SPDX-License-Identifier: Apache-2.0
#include "preselect/compare.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "signature_of.hpp"
#include "support/building.hpp"
#include "tally_twin.hpp"

namespace gridmerge::internal {
namespace {

using test::draw_building;
using test::map_part;
using test::metres_of_one;
using test::signature_of;
using test::tally_twin;

/// The pose that was found, between the grid frames.
SE2 between_grids(const SignatureMatch& match, const Signature& fixed, const Signature& moving) {
  return inverse(fixed.T_map_grid) * match.T_fixed_moving * moving.T_map_grid;
}

TEST(Compare, SaysOfItsPoseWhatAWalkOverAllWallsSays) {
  for (unsigned seed = 1; seed < 9; ++seed) {
    const unsigned other = seed % 2 == 0 ? seed : seed + 100;  // of one building, and of two
    const Signature a = signature_of(map_part(draw_building(seed), {0, 0, 13, 13}, {1.0, 2.0, 0.4}));
    const Signature b = signature_of(map_part(draw_building(other), {4, 0, 18, 13}, {-3.0, 7.0, -1.1}));
    const SignatureMatch match = compare(a, b);
    const SE2 T = between_grids(match, a, b);
    const Tally all = tally_twin(a, b, GridPose::of(T.x, T.y, T.theta), 1);
    // A wall that lies on the edge of a cell may be in either.
    const double wall = 0.51 * std::max(metres_of_one(a), metres_of_one(b));
    EXPECT_NEAR(match.seen, all.seen, wall) << seed;
    EXPECT_NEAR(match.met, all.met, wall) << seed;
    EXPECT_NEAR(match.open, all.open, wall) << seed;
    EXPECT_NEAR(match.chance, all.chance, wall) << seed;
    EXPECT_GT(match.seen, match.met + match.open) << seed;
  }
}

TEST(Compare, AMapLiesOnItself) {
  for (unsigned seed = 1; seed < 5; ++seed) {
    const Signature map = signature_of(map_part(draw_building(seed), {0, 0, 15, 13}, {1.0, 2.0, 0.4}));
    const SignatureMatch match = compare(map, map);
    EXPECT_NEAR(match.T_fixed_moving.x, 0.0, 1e-9);
    EXPECT_NEAR(match.T_fixed_moving.y, 0.0, 1e-9);
    EXPECT_NEAR(match.T_fixed_moving.theta, 0.0, 1e-9);
    EXPECT_NEAR(match.seen, map.wall_length, 1e-6);
    EXPECT_NEAR(match.met, map.wall_length, 0.02 * map.wall_length);
    EXPECT_EQ(match.open, 0.0);
    EXPECT_NEAR(match.likeness, 1.0, 0.01);
    // Every corner votes for this pose, as far as votes are counted, with its likeness to itself.
    EXPECT_GT(match.votes, 0.8 * std::min(static_cast<double>(map.keypoints.size()), 48.0));
    EXPECT_LE(match.votes, 48.5);
    EXPECT_LT(match.next_votes, 0.5 * match.votes);
  }
}

TEST(Compare, ATurnedMapLiesOnItselfWithAsManyVotes) {
  const OccupancyGrid part = map_part(draw_building(1), {0, 0, 15, 12}, {});
  OccupancyGrid map = make_grid(160, 128, part.resolution);
  for (int row = 0; row < std::min(map.height, part.height); ++row) {
    for (int column = 0; column < std::min(map.width, part.width); ++column)
      map.at(column, row) = part.at(column, row);
  }
  const Signature whole = make_signature(map);
  const double votes = compare(whole, whole).votes;
  SE2 T_map_turned;
  OccupancyGrid turned = map;
  for (int quarters = 1; quarters < 4; ++quarters) {
    // What was +x is +y; the origin goes to the new lower-left corner.
    OccupancyGrid next = make_grid(turned.height, turned.width, turned.resolution);
    for (int row = 0; row < turned.height; ++row) {
      for (int column = 0; column < turned.width; ++column)
        next.at(turned.height - 1 - row, column) = turned.at(column, row);
    }
    T_map_turned =
        T_map_turned * inverse(SE2{turned.height * turned.resolution, 0.0, 0.5 * std::numbers::pi});
    turned = next;
    const Signature other = make_signature(turned);
    const SignatureMatch match = compare(whole, other);
    EXPECT_NEAR(match.T_fixed_moving.x, T_map_turned.x, 0.1) << quarters;
    EXPECT_NEAR(match.T_fixed_moving.y, T_map_turned.y, 0.1) << quarters;
    EXPECT_NEAR(normalize_angle(match.T_fixed_moving.theta - T_map_turned.theta), 0.0, 0.02) << quarters;
    EXPECT_NEAR(match.votes, votes, 0.1 * votes) << quarters;
    EXPECT_GT(match.met, 0.9 * match.seen) << quarters;
    EXPECT_GT(match.likeness, 0.95) << quarters;
  }
}

TEST(Compare, PrefersNeitherMap) {
  const OccupancyGrid building = draw_building(1);
  const SE2 T_a_building{3.0, -2.0, 0.2}, T_b_building{-11.0, 40.0, 1.4};
  const Signature a = signature_of(map_part(building, {0, 0, 12, 13}, T_a_building));
  const Signature b = signature_of(map_part(building, {5, 0, 18, 13}, T_b_building));
  const SignatureMatch one = compare(a, b), other = compare(b, a);
  EXPECT_EQ(one.likeness, other.likeness);
  // The corners that are most alike are the same either way, and so are those that agree.
  EXPECT_NEAR(one.votes, other.votes, 0.35 * one.votes);
  EXPECT_NEAR(one.met, other.met, 0.1 * one.met);
  EXPECT_NEAR(one.seen, other.seen, 0.1 * one.seen);
}

TEST(Compare, RoomsThatLookAlikeVoteForARival) {
  // Two rooms of 7 m x 6 m that are the same, and what stands in each of them.
  OccupancyGrid twins = make_grid(300, 140, 0.05);
  for (int row = 10; row < 130; ++row) {
    for (int column = 10; column < 290; ++column) {
      const int u = (column - 10) % 140, v = row - 10;
      const bool is_wall = u < 3 || u >= 137 || v < 3 || v >= 117;
      const bool stands = (u > 30 && u < 50 && v > 20 && v < 60) || (u > 90 && u < 97 && v > 70 && v < 117);
      twins.at(column, row) = is_wall || stands ? Cell::occupied : Cell::free;
    }
  }
  const Signature map = make_signature(twins);
  const SignatureMatch match = compare(map, map);
  EXPECT_NEAR(match.T_fixed_moving.x, 0.0, 1e-9);
  EXPECT_GT(match.next_votes, 0.15 * match.votes);
  EXPECT_LT(match.next_votes, match.votes);
}

TEST(Compare, RefinesToLessThanACell) {
  const OccupancyGrid building = draw_building(1);
  double sum = 0.0;
  int count = 0;
  for (double theta = -3.0; theta < 3.0; theta += 0.37, ++count) {
    const SE2 T_b_building{-11.0, 40.0, theta};
    const Signature a = signature_of(map_part(building, {0, 0, 13, 13}, {}));
    const Signature b = signature_of(map_part(building, {4, 0, 18, 13}, T_b_building));
    const SE2 T = compare(a, b).T_fixed_moving * T_b_building;
    const Point2 at = T * Point2{9.0, 6.5};
    sum += std::hypot(at.x - 9.0, at.y - 6.5);
    EXPECT_LT(std::abs(normalize_angle(T.theta)), 0.05) << theta;
  }
  EXPECT_LT(sum / count, 0.15);
}

TEST(Compare, NoWallsSayNothing) {
  const Signature good = signature_of(draw_building(1));
  const Signature empty = make_signature(make_grid(50, 50, 0.05, {}, Cell::free));
  for (const SignatureMatch& match : {compare(good, empty), compare(empty, good), compare(empty, empty)}) {
    EXPECT_EQ(match.seen, 0.0);
    EXPECT_EQ(match.met, 0.0);
    EXPECT_EQ(match.votes, 0.0);
    EXPECT_EQ(match.next_votes, 0.0);
    EXPECT_EQ(match.likeness, 0.0);
    EXPECT_EQ(match.T_fixed_moving, SE2{});
  }
}

}  // namespace
}  // namespace gridmerge::internal
