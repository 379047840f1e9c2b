// SPDX-License-Identifier: Apache-2.0
#include "preselect/signature.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "grid/quarter_turned.hpp"
#include "gridmerge/grid/resample.hpp"
#include "preselect/chance.hpp"
#include "preselect/compare.hpp"
#include "signature_of.hpp"
#include "support/building.hpp"

namespace gridmerge::internal {
namespace {

using test::draw_building;
using test::map_part;
using test::signature_of;

/// How far the found pose puts the middle of an 18 m x 13 m floor from where it belongs [m].
double error(const SE2& found, const SE2& expected, const SE2& T_map_building) {
  const Point2 middle = T_map_building * Point2{9.0, 6.5};
  const Point2 at = found * middle, belongs = expected * middle;
  return std::hypot(at.x - belongs.x, at.y - belongs.y) +
         5.0 * std::abs(normalize_angle(found.theta - expected.theta));
}

class Turned : public testing::TestWithParam<double> {};

TEST_P(Turned, AMapIsFoundAtAnyAngle) {
  const OccupancyGrid building = draw_building(1);
  const SE2 T_a_building{3.0, -2.0, 0.2}, T_b_building{-11.0, 40.0, GetParam()};
  const Signature a = signature_of(map_part(building, {0, 0, 13, 13}, T_a_building));
  const Signature b = signature_of(map_part(building, {4, 0, 18, 13}, T_b_building));
  const SE2 expected = T_a_building * inverse(T_b_building);
  const SignatureMatch match = compare(a, b);
  EXPECT_LT(error(match.T_fixed_moving, expected, T_b_building), 1.0);
  EXPECT_GT(match.met, 0.6 * match.seen);
  // And the other way round.
  EXPECT_LT(error(inverse(compare(b, a).T_fixed_moving), expected, T_b_building), 1.0);
}

INSTANTIATE_TEST_SUITE_P(Angles, Turned,
                         testing::Values(0.0, 0.31, 0.785, 1.2, 1.5708, 2.3, 3.14159, -0.6, -1.9, -2.9));

TEST(Signature, AFloorIsLikelierItselfThanAnother) {
  const OccupancyGrid building = draw_building(1);
  const Signature a = signature_of(map_part(building, {0, 0, 13, 13}, {1.0, 2.0, 0.4}));
  const Signature b = signature_of(map_part(building, {4, 0, 18, 13}, {-3.0, 7.0, -1.1}));
  const double same = log_odds_of_joining(compare(a, b), a, b);
  for (unsigned seed = 2; seed < 8; ++seed) {
    const Signature other = signature_of(map_part(draw_building(seed), {4, 0, 18, 13}, {-3.0, 7.0, -1.1}));
    EXPECT_GT(same, log_odds_of_joining(compare(a, other), a, other) + 1.0) << seed;
  }
}

TEST(Signature, ResolutionsMayDiffer) {
  const OccupancyGrid building = draw_building(1);
  const SE2 T_a_building{0.0, 0.0, 0.0}, T_b_building{5.0, 5.0, 0.9};
  const OccupancyGrid fine = map_part(building, {0, 0, 18, 13}, T_a_building);
  const Signature a = signature_of(fine);
  const Signature b = signature_of(downsample(map_part(building, {2, 0, 18, 13}, T_b_building), 2));
  EXPECT_LT(error(compare(a, b).T_fixed_moving, T_a_building * inverse(T_b_building), T_b_building), 1.0);
}

TEST(Signature, BordersPlayNoPart) {
  const OccupancyGrid map = map_part(draw_building(1), {0, 0, 18, 13}, {1.0, 2.0, 0.4});
  OccupancyGrid wide = make_grid(map.width + 80, map.height + 50, map.resolution, map.origin);
  for (int row = 0; row < map.height; ++row) {
    for (int column = 0; column < map.width; ++column) wide.at(column, row) = map.at(column, row);
  }
  const Signature a = signature_of(map), b = signature_of(wide);
  EXPECT_EQ(a.keypoints.size(), b.keypoints.size());
  EXPECT_EQ(a.descriptors, b.descriptors);
}

TEST(Signature, QuartersOfADescriptorAreThoseOfTheMap) {
  const Signature a = signature_of(draw_building(3));
  ASSERT_FALSE(a.descriptors.empty());
  EXPECT_EQ(quarter_turned(a.descriptors[0], 4), a.descriptors[0]);
  EXPECT_EQ(quarter_turned(quarter_turned(a.descriptors[0], 1), 3), a.descriptors[0]);
  EXPECT_NE(quarter_turned(a.descriptors[0], 1), a.descriptors[0]);
}

double length(const Descriptor& descriptor) {
  double squares = 0.0;
  for (const std::int16_t value : descriptor) squares += static_cast<double>(value) * value;
  return std::sqrt(squares);
}

double likeness(const Descriptor& a, const Descriptor& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += static_cast<double>(a[i]) * b[i];
  return sum / (length(a) * length(b));
}

/// The same map, seen by a robot whose frame lies a quarter of a turn clockwise: what was +x is +y now.
OccupancyGrid quarter_turned_map(const OccupancyGrid& map) {
  OccupancyGrid turned = make_grid(map.height, map.width, map.resolution);
  for (int row = 0; row < map.height; ++row) {
    for (int column = 0; column < map.width; ++column)
      turned.at(map.height - 1 - row, column) = map.at(column, row);
  }
  return turned;
}

TEST(Signature, OfAMapThatIsTurnedByAQuarterIsTurned) {
  const OccupancyGrid map = map_part(draw_building(1), {0, 0, 16, 12}, {0.0, 0.0, 0.35});
  OccupancyGrid cropped = crop_to_known(map);
  cropped.origin = {};
  OccupancyGrid whole =
      make_grid((cropped.width + 3) / 4 * 4, (cropped.height + 3) / 4 * 4, cropped.resolution);
  for (int row = 0; row < cropped.height; ++row) {
    for (int column = 0; column < cropped.width; ++column) whole.at(column, row) = cropped.at(column, row);
  }
  const Signature a = make_signature(whole), b = make_signature(quarter_turned_map(whole));
  EXPECT_EQ(a.wall_length, b.wall_length);
  EXPECT_EQ(a.known_area, b.known_area);
  EXPECT_NEAR(a.chance_of_meeting, b.chance_of_meeting, 0.02 * a.chance_of_meeting);
  const double height = whole.height * whole.resolution;
  std::size_t found = 0, alike = 0;
  for (std::size_t i = 0; i < a.keypoints.size(); ++i) {
    const Point2 seen = a.T_map_grid * a.keypoints[i].position;
    const Point2 expected{height - seen.y, seen.x};
    for (std::size_t j = 0; j < b.keypoints.size(); ++j) {
      const Point2 at = b.T_map_grid * b.keypoints[j].position;
      if (std::hypot(at.x - expected.x, at.y - expected.y) > 0.05) continue;
      ++found;
      const double off = normalize_angle(4.0 * (a.keypoints[i].theta - b.keypoints[j].theta)) / 4.0;
      EXPECT_NEAR(off, 0.0, 0.02);
      // The direction is known up to quarters: one of the four lies so, and no other.
      double best = -1.0;
      for (int quarters = 0; quarters < 4; ++quarters)
        best = std::max(best, likeness(quarter_turned(a.descriptors[i], quarters), b.descriptors[j]));
      alike += best > 0.9 ? 1 : 0;
    }
  }
  EXPECT_GE(found, 9 * a.keypoints.size() / 10);
  EXPECT_GE(alike, 9 * found / 10);
}

TEST(Signature, KeypointsAreCornersApartFromEachOther) {
  // Two rooms of 6 m x 6 m side by side: six corners, of which two are T-junctions.
  OccupancyGrid map = make_grid(280, 160, 0.05);
  for (int row = 20; row < 141; ++row) {
    for (int column = 20; column < 261; ++column) {
      const bool is_wall =
          row < 22 || row >= 139 || column < 22 || column >= 259 || std::abs(column - 140) < 2;
      map.at(column, row) = is_wall ? Cell::occupied : Cell::free;
    }
  }
  const Signature signature = make_signature(map);
  ASSERT_EQ(signature.keypoints.size(), signature.descriptors.size());
  for (std::size_t i = 0; i < signature.keypoints.size(); ++i) {
    const Keypoint& keypoint = signature.keypoints[i];
    const Point2 corner = signature.T_map_grid * keypoint.position;
    EXPECT_GE(keypoint.theta, 0.0);
    EXPECT_LT(keypoint.theta, 1.5708);
    EXPECT_NEAR(normalize_angle(4.0 * keypoint.theta), 0.0, 0.1);  // the walls are along the axes
    double nearest = 1e9;
    for (const double x : {1.0, 7.0, 13.0}) {
      for (const double y : {1.0, 7.0}) nearest = std::min(nearest, std::hypot(corner.x - x, corner.y - y));
    }
    EXPECT_LT(nearest, 1.2);  // not along the walls
    for (std::size_t j = 0; j < i; ++j) {
      const Point2& other = signature.keypoints[j].position;
      EXPECT_GT(std::hypot(keypoint.position.x - other.x, keypoint.position.y - other.y), 0.8);
    }
    EXPECT_LE(length(signature.descriptors[i]), 4096.0 + 5.0);  // rounded
  }
  for (const double x : {1.0, 7.0, 13.0}) {
    for (const double y : {1.0, 7.0}) {
      EXPECT_TRUE(std::any_of(signature.keypoints.begin(), signature.keypoints.end(),
                              [&](const Keypoint& one) {
                                const Point2 at = signature.T_map_grid * one.position;
                                return std::hypot(at.x - x, at.y - y) < 1.2;
                              }))
          << x << ' ' << y;
    }
  }
}

TEST(Signature, ADescriptorIsShorterWhereLittleWasSeen) {
  const Signature wide = signature_of(draw_building(1));
  double longest = 0.0;
  for (const Descriptor& one : wide.descriptors) longest = std::max(longest, length(one));
  EXPECT_NEAR(longest, 4096.0, 5.0);
  // A closet of 1.5 m x 1.5 m: all rings but two lie outside of what was seen.
  OccupancyGrid closet = make_grid(200, 200, 0.05);
  for (int row = 85; row < 115; ++row) {
    for (int column = 85; column < 115; ++column) {
      const bool is_wall = row < 87 || row >= 113 || column < 87 || column >= 113;
      closet.at(column, row) = is_wall ? Cell::occupied : Cell::free;
    }
  }
  const Signature small = make_signature(closet);
  ASSERT_FALSE(small.descriptors.empty());
  for (const Descriptor& one : small.descriptors) {
    EXPECT_LT(length(one), 0.75 * 4096.0);
    EXPECT_GT(length(one), 0.2 * 4096.0);
  }
}

TEST(Signature, SumsAreThoseOfTheMap) {
  const OccupancyGrid map = map_part(draw_building(2), {0, 0, 11, 13}, {1.0, 2.0, 0.4});
  std::size_t known = 0;
  for (int row = 0; row < map.height; ++row) {
    for (int column = 0; column < map.width; ++column) known += map.at(column, row) != Cell::unknown ? 1 : 0;
  }
  const Signature signature = make_signature(map);
  EXPECT_NEAR(signature.known_area, map.resolution * map.resolution * static_cast<double>(known), 1e-6);
  EXPECT_EQ(signature.cell, 0.2);
  EXPECT_EQ(signature.walls.size(), 240U);  // of more
  EXPECT_GT(signature.wall_length, 240.0 * 0.2);
  EXPECT_EQ(signature.places.size(), static_cast<std::size_t>(signature.width) * signature.height);
  // Samples are spread over all walls, and each lies on one.
  double lowest = 1e9, highest = -1e9;
  for (const SampledWall& wall : signature.walls) {
    EXPECT_EQ(signature.place_at(wall.position).distance, 0);
    EXPECT_NE(wall.facing, kNoDirection);
    lowest = std::min(lowest, wall.position.y);
    highest = std::max(highest, wall.position.y);
  }
  EXPECT_GT(highest - lowest, 0.8 * signature.height * signature.cell);
  // Half a metre is met, a metre is open; nine of 32 directions are the same.
  EXPECT_EQ(signature.met_within, 2);
  EXPECT_EQ(signature.open_from, 5);
  std::size_t seen = 0, near = 0;
  for (const Place& place : signature.places) {
    seen += place.distance != kUnseen ? 1 : 0;
    near += place.distance <= 2 ? 1 : 0;
  }
  EXPECT_NEAR(signature.chance_of_meeting, 9.0 / 32.0 * static_cast<double>(near) / static_cast<double>(seen),
              0.01);
}

TEST(Signature, LargeMapsHaveLargerCells) {
  EXPECT_EQ(make_signature(make_grid(100, 100, 0.05)).cell, 0.2);
  EXPECT_EQ(make_signature(make_grid(100, 100, 0.4)).cell, 0.4);
  // 2,048 x 2,048 cells of 0.2 m would be four million: a million of 0.4 m are kept.
  EXPECT_NEAR(make_signature(make_grid(2048, 2048, 0.2)).cell, 0.4, 0.01);
}

TEST(Signature, HostileMapsSayNothing) {
  const Signature good = signature_of(draw_building(1));
  OccupancyGrid line = make_grid(100, 100, 0.05, {}, Cell::free);
  for (int column = 0; column < 100; ++column) line.at(column, 50) = Cell::occupied;
  OccupancyGrid turned = draw_building(2);
  turned.origin = {1e6, -1e6, 3.0};
  const std::vector<std::pair<std::string, OccupancyGrid>> maps{
      {"one cell", make_grid(1, 1, 0.05)},
      {"unknown", make_grid(300, 200, 0.05)},
      {"free", make_grid(300, 200, 0.05, {}, Cell::free)},
      {"occupied", make_grid(300, 200, 0.05, {}, Cell::occupied)},
      {"one wall", line},
      {"huge", make_grid(6000, 6000, 0.1, {}, Cell::free)},
      {"coarse", make_grid(20, 20, 50.0, {}, Cell::free)},
      {"far off", turned},
  };
  for (const auto& [name, map] : maps) {
    const Signature signature = make_signature(map);
    for (const SignatureMatch& match :
         {compare(good, signature), compare(signature, good), compare(signature, signature)}) {
      EXPECT_TRUE(std::isfinite(match.T_fixed_moving.x) && std::isfinite(match.T_fixed_moving.theta)) << name;
      EXPECT_TRUE(std::isfinite(log_odds_of_joining(match, good, signature))) << name;
    }
    EXPECT_LE(signature.places.size(), std::size_t{1} << 21) << name;
    if (name != "far off") {
      EXPECT_LT(log_odds_of_joining(compare(good, signature), good, signature), 0.0) << name;
    }
  }
}

}  // namespace
}  // namespace gridmerge::internal
