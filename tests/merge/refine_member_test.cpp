// SPDX-License-Identifier: Apache-2.0
#include "merge/refine_member.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

#include "support/building.hpp"

namespace gridmerge {

using namespace internal;
namespace {

const OccupancyGrid kBuilding = test::draw_building(4);
const SE2 T_a_building{-3.0, 2.0, 0.4}, T_b_building{1.0, -7.0, -1.1}, T_c_building{30.0, 5.0, 2.0};
const OccupancyGrid kA = test::map_part(kBuilding, {0, 0, 9, 13}, T_a_building);
const OccupancyGrid kB = test::map_part(kBuilding, {7, 0, 18, 13}, T_b_building);
const OccupancyGrid kC = test::map_part(kBuilding, {4, 0, 14, 13}, T_c_building);
/// Where the page lays the building.
const SE2 T_page_building{-20.0, 100.0, -2.5};

PlacedMap placed(const OccupancyGrid& map, const SE2& T_map_building) {
  return {&map, T_page_building * inverse(T_map_building)};
}

void expect_true_pose(const RefinedPose& refined, const SE2& truth) {
  const Point2 middle = T_c_building * Point2{9.0, 6.5};
  const Point2 found = refined.T_fixed_moving * middle, true_place = truth * middle;
  EXPECT_LT(std::hypot(found.x - true_place.x, found.y - true_place.y), 0.1);
  EXPECT_NEAR(std::remainder(refined.T_fixed_moving.theta - truth.theta, 2.0 * 3.14159265358979), 0.0, 0.007);
  EXPECT_GT(refined.probability, 0.8);
}

TEST(RefineMember, FitsInAmongTheOthersWhereverTheyLie) {
  PlacedMap moving = placed(kC, T_c_building);
  const SE2 truth = moving.T_output_map;
  moving.T_output_map.x += 0.4;
  moving.T_output_map.y -= 0.2;
  const std::vector<PlacedMap> both{placed(kA, T_a_building), placed(kB, T_b_building)};
  const RefinedPose among_both = refine_member(both, moving);
  expect_true_pose(among_both, truth);
  const RefinedPose on_one = refine_member({both.front()}, moving);
  expect_true_pose(on_one, truth);
  EXPECT_GT(among_both.overlap, on_one.overlap);
}

TEST(RefineMember, RefusesWhatItCannotFuse) {
  const PlacedMap moving = placed(kC, T_c_building);
  EXPECT_THROW(refine_member({}, moving), std::invalid_argument);
  const PlacedMap far{&kB, {1e6, 1e6, 0.0}},
      nowhere{&kB, {std::numeric_limits<double>::quiet_NaN(), 0.0, 0.0}};
  EXPECT_THROW(refine_member({placed(kA, T_a_building), far}, moving), std::invalid_argument);
  EXPECT_THROW(refine_member({placed(kA, T_a_building), nowhere}, moving), std::invalid_argument);
  EXPECT_THROW(refine_member({nowhere}, moving), std::invalid_argument);
  EXPECT_THROW(refine_member({PlacedMap{}}, moving), std::invalid_argument);
  EXPECT_THROW(refine_member({placed(kA, T_a_building)}, PlacedMap{}), std::invalid_argument);
}

}  // namespace
}  // namespace gridmerge
