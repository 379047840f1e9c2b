// SPDX-License-Identifier: Apache-2.0
#include "preselect/signature.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "gridmerge/grid/resample.hpp"
#include "preselect/chance.hpp"
#include "preselect/compare.hpp"
#include "support/building.hpp"

namespace gridmerge::internal {
namespace {

using test::draw_building;
using test::map_part;

Signature signature_of(const OccupancyGrid& map) {
  return make_signature(crop_to_known(map));
}

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
