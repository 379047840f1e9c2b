// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <numbers>

#include "evaluate/known_moments.hpp"
#include "gridmerge/evaluate/evaluate.hpp"

namespace gridmerge {
namespace {

double brute_force(const OccupancyGrid& map, const SE2& T_estimate, const SE2& T_truth) {
  double sum = 0.0, count = 0.0;
  for (int row = 0; row < map.height; ++row) {
    for (int column = 0; column < map.width; ++column) {
      if (map.at(column, row) == Cell::unknown) continue;
      const Point2 p = map.cell_centre(column, row);
      const Point2 a = T_estimate * p, b = T_truth * p;
      sum += (a.x - b.x) * (a.x - b.x) + (a.y - b.y) * (a.y - b.y);
      count += 1.0;
    }
  }
  return std::sqrt(sum / count);
}

double real_between(int low, int high) {
  return *rc::gen::inRange(low * 1000, high * 1000) / 1000.0;
}

SE2 any_pose() {
  return {real_between(-50, 50), real_between(-50, 50), normalize_angle(real_between(-4, 4))};
}

OccupancyGrid any_map() {
  const int width = *rc::gen::inRange(1, 12), height = *rc::gen::inRange(1, 12);
  OccupancyGrid map = make_grid(width, height, *rc::gen::element(0.05, 0.1, 1.0), any_pose());
  for (Cell& cell : map.cells) cell = *rc::gen::element(Cell::unknown, Cell::free, Cell::occupied);
  map.at(*rc::gen::inRange(0, width), *rc::gen::inRange(0, height)) = Cell::free;
  return map;
}

RC_GTEST_PROP(RmsDisplacement, EqualsTheSumOverAllCells, ()) {
  const OccupancyGrid map = any_map();
  const SE2 T_estimate = any_pose(), T_truth = any_pose();
  const double expected = brute_force(map, T_estimate, T_truth);
  RC_ASSERT(std::abs(rms_displacement(map, T_estimate, T_truth) - expected) <= 1e-9 * (1.0 + expected));
}

RC_GTEST_PROP(RmsDisplacement, DoesNotDependOnWhichTransformIsTheTruth, ()) {
  const internal::KnownMoments moments = internal::known_moments(any_map());
  const SE2 a = any_pose(), b = any_pose();
  RC_ASSERT(rms_displacement(moments, a, b) == rms_displacement(moments, b, a));
  RC_ASSERT(rms_displacement(moments, a, a) == 0.0);
}

TEST(RmsDisplacement, OfAShiftIsItsLength) {
  const OccupancyGrid map = make_grid(30, 20, 0.1, {5.0, -7.0, 0.3}, Cell::free);
  EXPECT_NEAR(rms_displacement(map, {4.0, 6.0, 1.0}, {1.0, 2.0, 1.0}), 5.0, 1e-12);
}

TEST(RmsDisplacement, AnglesOnBothSidesOfHalfATurnAreClose) {
  const OccupancyGrid map = make_grid(10, 10, 0.1, {}, Cell::free);
  EXPECT_LT(rms_displacement(map, {0, 0, std::numbers::pi - 1e-6}, {0, 0, -std::numbers::pi + 1e-6}), 1e-5);
}

TEST(RmsDisplacement, OfWhatIsNoMapThereIsNone) {
  OccupancyGrid map;
  map.width = map.height = 4000;  // and no cells
  EXPECT_THROW(rms_displacement(map, {}, {1.0, 0.0, 0.0}), std::invalid_argument);
}

TEST(RmsDisplacement, OfAMapWithNoKnownCellIsThatOfItsMiddle) {
  const OccupancyGrid map = make_grid(20, 10, 0.1, {3.0, 0.0, 0.0});
  EXPECT_EQ(internal::known_moments(map).centroid, (Point2{4.0, 0.5}));
  EXPECT_EQ(rms_displacement(map, {1.0, 0.0, 0.0}, {}), 1.0);
}

}  // namespace
}  // namespace gridmerge
