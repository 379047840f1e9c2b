// SPDX-License-Identifier: Apache-2.0
#include "preselect/tally.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <limits>
#include <random>

#include "signature_of.hpp"
#include "support/building.hpp"
#include "tally_twin.hpp"

namespace gridmerge::internal {
namespace {

using test::draw_building;
using test::map_part;
using test::signature_of;
using test::tally_twin;

TEST(TallyBoth, SaysWhatAWalkOverTheWallsSays) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> shift(-30.0, 30.0), angle(-7.0, 7.0);
  double seen = 0.0, met = 0.0, open = 0.0;
  for (unsigned seed = 1; seed < 5; ++seed) {
    const Signature a = signature_of(map_part(draw_building(seed), {0, 0, 13, 13}, {}));
    const Signature b = signature_of(map_part(draw_building(seed), {4, 0, 18, 13}, {0.0, 0.0, 0.3}));
    ASSERT_GT(a.walls.size(), 128U);  // more than two blocks of 64
    for (int i = 0; i < 300; ++i) {
      // Most overlap in part, some by a sliver or not at all.
      const GridPose T = GridPose::of(shift(random), shift(random), angle(random));
      for (const std::size_t step : {1, 2, 3, 6, 64, 1000}) {
        const Tally tally = tally_both(a, b, T, step), twin = tally_twin(a, b, T, step);
        EXPECT_NEAR(tally.seen, twin.seen, 1e-9);
        EXPECT_NEAR(tally.met, twin.met, 1e-9);
        EXPECT_NEAR(tally.open, twin.open, 1e-9);
        EXPECT_NEAR(tally.chance, twin.chance, 1e-9);
        seen += tally.seen;
        met += tally.met;
        open += tally.open;
      }
    }
  }
  EXPECT_GT(met, 0.1 * seen);
  EXPECT_GT(open, 0.03 * seen);
}

TEST(TallyBoth, OfAMapThatLiesOnItselfAllWallsMeet) {
  const Signature map = signature_of(map_part(draw_building(3), {0, 0, 13, 13}, {}));
  const Tally tally = tally_both(map, map, GridPose::of(0.0, 0.0, 0.0), 1);
  EXPECT_NEAR(tally.seen, map.wall_length, 1e-9);
  EXPECT_NEAR(tally.met, map.wall_length, 1e-9);
  EXPECT_EQ(tally.open, 0.0);
}

TEST(TallyBoth, OfMapsFarApartOrWithoutWallsIsNothing) {
  const Signature map = signature_of(map_part(draw_building(3), {0, 0, 13, 13}, {})), none;
  for (const GridPose& T :
       {GridPose::of(1e3, 0.0, 0.3), GridPose::of(-1e9, 1e9, 2.0), GridPose::of(0.0, -1e300, 0.0)}) {
    EXPECT_EQ(tally_both(map, map, T, 1).seen, 0.0);
  }
  const double inf = std::numeric_limits<double>::infinity(), nan = std::nan("");
  for (const GridPose& T : {GridPose{inf, 0.0, 0.0, 1.0, 0.0}, GridPose{0.0, nan, 0.0, 1.0, 0.0},
                            GridPose{-inf, inf, 0.0, nan, 0.0}}) {
    EXPECT_EQ(tally_both(map, map, T, 1).seen, 0.0);
  }
  const GridPose here = GridPose::of(0.0, 0.0, 0.0);
  EXPECT_EQ(tally_both(map, none, here, 1).seen, 0.0);
  EXPECT_EQ(tally_both(none, map, here, 1).seen, 0.0);
  EXPECT_EQ(tally_both(none, none, here, 1).seen, 0.0);
}

TEST(GridPose, ThereAndBackIsHere) {
  const GridPose T = GridPose::of(3.0, -2.0, 2.5);
  const Point2 back = T.inverted() * (T * Point2{1.5, 4.0});
  EXPECT_NEAR(back.x, 1.5, 1e-12);
  EXPECT_NEAR(back.y, 4.0, 1e-12);
  const Point2 there = T * Point2{1.0, 0.0};
  EXPECT_NEAR(there.x, 3.0 + std::cos(2.5), 1e-12);
  EXPECT_NEAR(there.y, -2.0 + std::sin(2.5), 1e-12);
}

}  // namespace
}  // namespace gridmerge::internal
