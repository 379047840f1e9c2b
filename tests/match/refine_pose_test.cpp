// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <stdexcept>

#include "gridmerge/grid/execution.hpp"
#include "gridmerge/match/match.hpp"
#include "support/building.hpp"

namespace gridmerge {

using namespace internal;
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr double kDecided = 0.8;  // from this on a pair is accepted

/// Two robots' maps of one building, with frames of their own.
struct Pair {
  explicit Pair(unsigned seed)
      : fixed(test::map_part(test::draw_building(seed), {0, 0, 13, 13}, T_fixed_building)),
        moving(test::map_part(test::draw_building(seed), {5, 0, 18, 13}, T_moving_building)) {}

  SE2 T_fixed_building{-3.0, 2.0, 0.4};
  SE2 T_moving_building{1.0, -7.0, -1.1};
  SE2 truth = T_fixed_building * inverse(T_moving_building);
  PreparedMap fixed;
  PreparedMap moving;
};

/// The middle of the building, in the moving map's frame.
Point2 middle_of(const Pair& pair) {
  return pair.T_moving_building * Point2{9.0, 6.5};
}

double distance(const Point2& a, const Point2& b) {
  return std::hypot(a.x - b.x, a.y - b.y);
}

/// `T`, turned by `turn` about where it puts `p`, then shifted.
SE2 displaced(const SE2& T, const Point2& p, double dx, double dy, double turn) {
  const Point2 at = T * p;
  return SE2{at.x + dx, at.y + dy, turn} * SE2{-at.x, -at.y, 0.0} * T;
}

void expect_true_pose(const Pair& pair, const SE2& found) {
  EXPECT_LT(distance(found * middle_of(pair), pair.truth * middle_of(pair)), 0.1);
  EXPECT_NEAR(std::remainder(found.theta - pair.truth.theta, 2.0 * std::numbers::pi), 0.0, 0.4 * kDegree);
}

TEST(RefinePose, ClimbsBackFromSomeDecimetresAndDegrees) {
  std::mt19937 random(3);
  const auto uniform = [&](double most) {
    return most * (2.0 * static_cast<double>(random()) / static_cast<double>(std::mt19937::max()) - 1.0);
  };
  for (unsigned seed = 1; seed <= 8; ++seed) {
    const Pair pair(seed);
    for (int run = 0; run < 3; ++run) {
      const double dx = uniform(0.8), dy = uniform(0.8), turn = uniform(6.0 * kDegree);
      SCOPED_TRACE(testing::Message() << seed << ": " << dx << " m, " << dy << " m, " << turn << " rad");
      const SE2 start = displaced(pair.truth, middle_of(pair), dx, dy, turn);
      const RefinedPose refined = refine_pose(pair.fixed, pair.moving, start);
      expect_true_pose(pair, refined.T_fixed_moving);
      EXPECT_GE(refined.probability, kDecided);
      EXPECT_GT(refined.score, refined.start_score);
      EXPECT_GT(refined.acceptance_index, 0.9);
      // Of the walls, which lie some metres from the middle about which it was turned.
      EXPECT_NEAR(refined.moved, std::hypot(dx, dy), 7.0 * std::abs(turn) + 0.15);
    }
  }
}

TEST(RefinePose, SaysWhatMatchSays) {
  for (unsigned seed = 1; seed <= 3; ++seed) {
    const Pair pair(seed);
    const MatchResult found = match(pair.fixed, pair.moving);
    const RefinedPose refined = refine_pose(pair.fixed, pair.moving, found.T_fixed_moving);
    EXPECT_LT(refined.moved, 0.1);
    EXPECT_GE(refined.score, refined.start_score);
    EXPECT_NEAR(refined.start_score, found.hypotheses.front().score, 1e-6 * refined.score);
    EXPECT_NEAR(refined.probability, found.probability, 1e-3);
    EXPECT_NEAR(refined.acceptance_index, found.acceptance_index, 0.01);
    EXPECT_NEAR(refined.overlap, found.overlap, 0.01);
  }
}

TEST(RefinePose, FarFromTheTruthItInventsNoJoin) {
  std::mt19937 random(5);
  for (unsigned seed = 1; seed <= 4; ++seed) {
    const Pair pair(seed);
    for (int run = 0; run < 4; ++run) {
      const double direction = 2.0 * std::numbers::pi * static_cast<double>(random() % 360) / 360.0;
      const double turn = (90.0 + static_cast<double>(random() % 180)) * kDegree;
      const SE2 start =
          displaced(pair.truth, middle_of(pair), 5.0 * std::cos(direction), 5.0 * std::sin(direction), turn);
      const RefinedPose refined = refine_pose(pair.fixed, pair.moving, start);
      EXPECT_LT(refined.probability, 0.05) << seed << " " << run;
    }
  }
}

TEST(RefinePose, OfTwoBuildingsItInventsNoJoin) {
  const PreparedMap one(test::draw_building(1)), another(test::draw_building(2));
  for (const double x : {-6.0, -2.0, 0.0, 3.0})
    EXPECT_LT(refine_pose(one, another, {x, 0.5, 0.0}).probability, 0.05) << x;
}

TEST(RefinePose, OfASymmetricBuildingIsNoBetterThanEven) {
  OccupancyGrid half = test::draw_building(1);
  OccupancyGrid both = make_grid(2 * half.width, half.height, half.resolution);
  for (int row = 0; row < half.height; ++row) {
    for (int column = 0; column < half.width; ++column) {
      both.at(column, row) = half.at(column, row);
      both.at(both.width - 1 - column, both.height - 1 - row) = half.at(column, row);
    }
  }
  const PreparedMap map(both);
  const double width = both.width * both.resolution, height = both.height * both.resolution;
  for (const SE2& T : {SE2{0.2, -0.1, 0.01}, SE2{width, height, std::numbers::pi}})
    EXPECT_LT(refine_pose(map, map, T).probability, kDecided);
}

TEST(RefinePose, StaysWhereNothingSpeaksForAnyPose) {
  const Pair pair(1);
  const SE2 start{5000.0, -1e7, 1.0};
  const RefinedPose refined = refine_pose(pair.fixed, pair.moving, start);
  EXPECT_EQ(refined.T_fixed_moving, start);
  EXPECT_EQ(refined.moved, 0.0);
  EXPECT_EQ(refined.score, 0.0);
  EXPECT_EQ(refined.probability, 0.0);
  EXPECT_EQ(refined.agreement + refined.disagreement, 0);
}

TEST(RefinePose, OfSmallCellsItLooksNoFurtherThanSomeCells) {
  const OccupancyGrid building = test::draw_building(1);
  const auto in_cells_of = [&](double cell) {
    OccupancyGrid grid = building;
    grid.resolution = cell;
    return PreparedMap(grid);
  };
  const auto left_over = [](const PreparedMap& map, double cell, double cells_off) {
    const RefinedPose refined = refine_pose(map, map, {cells_off * cell, 0.0, 0.0});
    return std::hypot(refined.T_fixed_moving.x, refined.T_fixed_moving.y) / cell;
  };
  const PreparedMap fine = in_cells_of(0.005);
  EXPECT_LT(left_over(fine, 0.005, 30.0), 1.0);
  ASSERT_GT(left_over(fine, 0.005, 150.0), 10.0) << "with yet smaller cells this would take all memory";
  for (const double cell : {1e-4, kMinResolution})
    EXPECT_LT(left_over(in_cells_of(cell), cell, 30.0), 1.0) << cell;
}

TEST(RefinePose, RefusesAStartThatIsNotFinite) {
  const PreparedMap map(test::draw_building(1));
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  for (const SE2& T : {SE2{kNaN, 0, 0}, SE2{0, kNaN, 0}, SE2{0, 0, std::numeric_limits<double>::infinity()}})
    EXPECT_THROW(refine_pose(map, map, T), std::invalid_argument);
}

TEST(RefinePose, OfMapsWithNothingToGoBy) {
  const PreparedMap building(test::draw_building(1));
  for (const OccupancyGrid& grid : {make_grid(30, 20, 0.1), make_grid(30, 20, 0.1, {}, Cell::free),
                                    make_grid(1, 1, 0.1, {}, Cell::occupied)}) {
    const PreparedMap nothing(grid);
    for (const PreparedMap* other : {&building, &nothing}) {
      EXPECT_LT(refine_pose(*other, nothing, {1.0, 2.0, 0.5}).probability, 0.01);
      EXPECT_LT(refine_pose(nothing, *other, {1.0, 2.0, 0.5}).probability, 0.01);
    }
  }
}

TEST(RefinePose, ItDoesNotMatterWhichMapIsFixed) {
  const Pair pair(2);
  const SE2 start = displaced(pair.truth, middle_of(pair), 0.4, -0.3, 0.05);
  const RefinedPose there = refine_pose(pair.fixed, pair.moving, start);
  const RefinedPose back = refine_pose(pair.moving, pair.fixed, inverse(start));
  const SE2 round_trip = there.T_fixed_moving * back.T_fixed_moving;
  EXPECT_NEAR(round_trip.x, 0.0, 0.05);
  EXPECT_NEAR(round_trip.y, 0.0, 0.05);
  EXPECT_NEAR(round_trip.theta, 0.0, 0.005);
  EXPECT_NEAR(there.score, back.score, 0.01 * there.score);
  EXPECT_NEAR(there.probability, back.probability, 1e-3);
}

TEST(RefinePose, TheNumberOfThreadsChangesNothing) {
  const Pair pair(3);
  const SE2 start = displaced(pair.truth, middle_of(pair), 0.5, 0.5, -0.05);
  RefinedPose one, two;
  with_threads(1, [&] { one = refine_pose(pair.fixed, pair.moving, start); });
  with_threads(2, [&] { two = refine_pose(pair.fixed, pair.moving, start); });
  EXPECT_EQ(one.T_fixed_moving, two.T_fixed_moving);
  EXPECT_EQ(one.score, two.score);
  EXPECT_EQ(one.probability, two.probability);
}

}  // namespace
}  // namespace gridmerge
