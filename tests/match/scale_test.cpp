// SPDX-License-Identifier: Apache-2.0
#include "match/scale.hpp"

#include <gtest/gtest.h>

#include "support/building.hpp"

namespace gridmerge {

using namespace internal;
namespace {

OccupancyGrid with_resolution(OccupancyGrid map, double factor) {
  map.resolution *= factor;
  map.origin.x *= factor;
  map.origin.y *= factor;
  return map;
}

TEST(Scale, IsFoundWhereOneMapsResolutionIsWrong) {
  const OccupancyGrid building = test::draw_building(1);
  const OccupancyGrid left = test::map_part(building, {0, 0, 13, 13}, {-3.0, 2.0, 0.4});
  const OccupancyGrid right = test::map_part(building, {5, 0, 18, 13}, {1.0, -7.0, -1.1});
  for (const double factor : {0.5, 2.0, 2.5}) {
    const OccupancyGrid wrong = with_resolution(right, 1.0 / factor);
    ASSERT_EQ(match(left, wrong).verdict, Verdict::refused) << factor;
    const std::optional<ScaleFound> found = find_scale(left, wrong);
    ASSERT_TRUE(found) << factor;
    EXPECT_EQ(found->factor, factor);
    EXPECT_GE(found->probability, 0.99);
  }
}

TEST(Scale, IsNotFoundBetweenStrangersNorOfNothing) {
  EXPECT_FALSE(find_scale(test::draw_building(1), test::draw_building(2)));
  EXPECT_FALSE(find_scale(test::draw_building(1), make_grid(40, 30, 0.1)));
}

TEST(Scale, IsNotSoughtWhereTheScaledMapWouldBeNone) {
  OccupancyGrid far = test::draw_building(2);
  far.origin.x = kMaxOrigin;  // ten times that is no map's
  EXPECT_NO_THROW(find_scale(test::draw_building(1), far));
}

}  // namespace
}  // namespace gridmerge
