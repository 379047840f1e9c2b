// SPDX-License-Identifier: Apache-2.0
#include "similarity/agreement.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>

#include "random_grid.hpp"

namespace gridmerge {

using namespace internal;
namespace {

/// Literal: every cell centre taken through the map frames.
AgreementCounts brute_force(const OccupancyGrid& fixed, const OccupancyGrid& moving,
                            const SE2& T_fixed_moving) {
  AgreementCounts result;
  for (int row = 0; row < moving.height; ++row) {
    for (int column = 0; column < moving.width; ++column) {
      const Point2 p = inverse(fixed.origin) * (T_fixed_moving * moving.cell_centre(column, row));
      const int x = static_cast<int>(std::floor(p.x / fixed.resolution));
      const int y = static_cast<int>(std::floor(p.y / fixed.resolution));
      if (!fixed.contains(x, y) || fixed.at(x, y) == Cell::unknown) continue;
      if (moving.at(column, row) == Cell::unknown) continue;
      ++(moving.at(column, row) == fixed.at(x, y) ? result.agreement : result.disagreement);
    }
  }
  return result;
}

RC_GTEST_PROP(Agreement, EqualsTheLiteralCount, (unsigned seed)) {
  const OccupancyGrid fixed = test::random_grid(seed, 30, 20, 0.1, {1.0, 2.0, 0.3});
  const OccupancyGrid moving = test::random_grid(seed + 1, 20, 30, 0.07, {-1.0, 0.5, -1.2});
  const SE2 T{*rc::gen::inRange(-300, 300) / 100.0 + 0.003, *rc::gen::inRange(-300, 300) / 100.0 + 0.007,
              *rc::gen::inRange(-314, 314) / 100.0};
  const AgreementCounts found = count_agreement(fixed, moving, T);
  const AgreementCounts expected = brute_force(fixed, moving, T);
  RC_ASSERT(found.agreement == expected.agreement);
  RC_ASSERT(found.disagreement == expected.disagreement);
}

TEST(Agreement, OfAMapWithItselfIsComplete) {
  const OccupancyGrid map = test::random_grid(2, 30, 20, 0.05, {1.0, 2.0, 0.0});
  const AgreementCounts found = count_agreement(map, map, {});
  EXPECT_EQ(found.agreement, static_cast<std::int64_t>(count_cells(map).known()));
  EXPECT_EQ(found.disagreement, 0);
  EXPECT_EQ(found.acceptance_index(), 1.0);
  EXPECT_EQ(measure_overlap(map, map, found), 1.0);
}

TEST(Agreement, AStrideEstimatesTheCounts) {
  const OccupancyGrid fixed = make_grid(200, 200, 0.1, {}, Cell::free);
  OccupancyGrid moving = fixed;
  for (int row = 0; row < 200; ++row) {
    for (int column = 0; column < 50; ++column) moving.at(column, row) = Cell::occupied;
  }
  const AgreementCounts found = AgreementCounter(fixed, moving, 5).count({});
  EXPECT_EQ(found.agreement, 150 * 200);
  EXPECT_EQ(found.disagreement, 50 * 200);
}

RC_GTEST_PROP(Agreement, AStrideLooksAtTheMiddleOfEachSquare, (unsigned seed)) {
  const OccupancyGrid fixed = test::random_grid(seed, 30, 20, 0.1, {1.0, 2.0, 0.3});
  const OccupancyGrid moving = test::random_grid(seed + 1, 23, 31, 0.07, {-1.0, 0.5, -1.2});
  const int stride = *rc::gen::inRange(1, 8);
  OccupancyGrid middles = make_grid(moving.width, moving.height, moving.resolution, moving.origin);
  for (int row = 0; row < moving.height; ++row) {
    for (int column = 0; column < moving.width; ++column) {
      if (row % stride == stride / 2 && column % stride == stride / 2)
        middles.at(column, row) = moving.at(column, row);
    }
  }
  const SE2 T{*rc::gen::inRange(-300, 300) / 100.0 + 0.003, *rc::gen::inRange(-300, 300) / 100.0 + 0.007,
              *rc::gen::inRange(-314, 314) / 100.0};
  const AgreementCounts found = AgreementCounter(fixed, moving, stride).count(T);
  const AgreementCounts expected = brute_force(fixed, middles, T);
  RC_ASSERT(found.agreement == expected.agreement * stride * stride);
  RC_ASSERT(found.disagreement == expected.disagreement * stride * stride);
}

TEST(Agreement, OfMapsApartIsNothing) {
  const OccupancyGrid map = test::random_grid(2, 30, 20);
  const AgreementCounts found = count_agreement(map, map, {100.0, 0.0, 0.0});
  EXPECT_EQ(found.agreement + found.disagreement, 0);
  EXPECT_EQ(found.acceptance_index(), 0.0);
  EXPECT_EQ(measure_overlap(map, map, found), 0.0);
}

TEST(Agreement, OverlapIsAShareOfTheSmallerMap) {
  const OccupancyGrid large = make_grid(20, 20, 0.1, {}, Cell::free);
  const OccupancyGrid small = make_grid(10, 10, 0.1, {}, Cell::free);
  for (const auto& [fixed, moving] : {std::pair(large, small), std::pair(small, large)}) {
    EXPECT_NEAR(measure_overlap(fixed, moving, count_agreement(fixed, moving, {})), 1.0, 1e-9);
  }
  EXPECT_NEAR(measure_overlap(large, small, count_agreement(large, small, {-0.5, 0.0, 0.0})), 0.5, 1e-9);
}

}  // namespace
}  // namespace gridmerge
