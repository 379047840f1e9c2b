// SPDX-License-Identifier: Apache-2.0
#include "match/pair_pose.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "gridmerge/match/match.hpp"
#include "match/prepared_map.hpp"
#include "support/building.hpp"

namespace gridmerge {

using namespace internal;
namespace {

const PreparedMap& large_map() {
  static const PreparedMap map(test::map_part(test::draw_building(1), {0, 0, 13, 13}, {-3.0, 2.0, 0.4}));
  return map;
}

const PreparedMap& small_map() {
  static const PreparedMap map(test::map_part(test::draw_building(1), {5, 2, 16, 10}, {1.0, -7.0, -1.1}));
  return map;
}

RC_GTEST_PROP(CountCommon, DoesNotDependOnWhichMapIsFixed, ()) {
  ASSERT_TRUE(is_smaller(small_map(), large_map()));
  const auto metres = [] { return *rc::gen::inRange(-900, 900) / 100.0; };
  PairPose onto_large, onto_small;
  onto_large.T_fixed_moving = {metres(), metres(), *rc::gen::inRange(-314, 314) / 100.0};
  onto_small.T_fixed_moving = inverse(onto_large.T_fixed_moving);
  // The same bits: the smaller map's cells are counted where the same transform puts them.
  onto_large.T_fixed_moving = inverse(onto_small.T_fixed_moving);
  count_common(large_map(), small_map(), onto_large);
  count_common(small_map(), large_map(), onto_small);
  RC_ASSERT(onto_large.agreement == onto_small.agreement);
  RC_ASSERT(onto_large.disagreement == onto_small.disagreement);
  RC_ASSERT(onto_large.acceptance_index == onto_small.acceptance_index);
  RC_ASSERT(onto_large.overlap == onto_small.overlap);
}

TEST(CountCommon, SaysOfAMatchWhatMatchSays) {
  for (const bool swapped : {false, true}) {
    const PreparedMap &fixed = swapped ? small_map() : large_map(),
                      &moving = swapped ? large_map() : small_map();
    const MatchResult result = match(fixed, moving);
    ASSERT_EQ(result.verdict, Verdict::accepted);
    PairPose pose;
    pose.T_fixed_moving = result.T_fixed_moving;
    pose.probability = 0.25;
    count_common(fixed, moving, pose);
    // Turned there and back, the pose may differ in its last bits, and so a cell on a boundary.
    EXPECT_NEAR(pose.acceptance_index, result.acceptance_index, 1e-3);
    EXPECT_NEAR(pose.overlap, result.overlap, 1e-3);
    EXPECT_GT(pose.agreement, 1000);
    EXPECT_EQ(pose.T_fixed_moving, result.T_fixed_moving);
    EXPECT_EQ(pose.probability, 0.25);
  }
}

TEST(CountCommon, MapsThatLieApartHaveNothingInCommon) {
  PairPose pose;
  pose.T_fixed_moving = {1000.0, 0.0, 0.0};
  pose.agreement = pose.disagreement = 7;
  pose.acceptance_index = pose.overlap = 0.5;
  count_common(large_map(), small_map(), pose);
  EXPECT_EQ(pose.agreement, 0);
  EXPECT_EQ(pose.disagreement, 0);
  EXPECT_EQ(pose.acceptance_index, 0.0);
  EXPECT_EQ(pose.overlap, 0.0);
}

}  // namespace
}  // namespace gridmerge
