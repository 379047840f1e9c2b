// SPDX-License-Identifier: Apache-2.0
#include "gridmerge/match/match.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <numbers>
#include <random>
#include <stdexcept>

#include "gridmerge/grid/execution.hpp"
#include "gridmerge/grid/resample.hpp"
#include "match/drawn_walls.hpp"
#include "support/building.hpp"

namespace gridmerge {

using namespace internal;
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;

/// A pose of any heading, some metres off.
SE2 random_pose(std::mt19937& random) {
  const auto uniform = [&](double low, double high) {
    return low + (high - low) * static_cast<double>(random()) / static_cast<double>(std::mt19937::max());
  };
  return {uniform(-20.0, 20.0), uniform(-20.0, 20.0), uniform(-std::numbers::pi, std::numbers::pi)};
}

void expect_near(const SE2& found, const SE2& truth, double metres, double radians) {
  EXPECT_NEAR(found.theta - truth.theta,
              2.0 * std::numbers::pi * std::round((found.theta - truth.theta) / (2.0 * std::numbers::pi)),
              radians);
  EXPECT_NEAR(found.x, truth.x, metres);
  EXPECT_NEAR(found.y, truth.y, metres);
}

TEST(Match, RecoversARotatedMapWithinHalfACell) {
  std::mt19937 random(4);
  const OccupancyGrid building = test::draw_building(1);
  for (int run = 0; run < 6; ++run) {
    const SE2 T_robot_building = random_pose(random);
    const OccupancyGrid turned = transform_grid(building, T_robot_building, building.resolution);
    const MatchResult result = match(building, turned);
    EXPECT_EQ(result.verdict, Verdict::accepted) << run;
    // At the middle of the building, where the rotation's own error does not reach far.
    const Point2 middle{9.0, 6.5};
    const Point2 back = result.T_fixed_moving * (T_robot_building * middle);
    EXPECT_NEAR(back.x, middle.x, 0.5 * building.resolution) << run;
    EXPECT_NEAR(back.y, middle.y, 0.5 * building.resolution) << run;
    EXPECT_NEAR(std::remainder(result.T_fixed_moving.theta + T_robot_building.theta, 2.0 * std::numbers::pi),
                0.0, 0.2 * kDegree)
        << run;
  }
}

TEST(PreparedMap, CanBeCancelledWhileItIsMadeAndDrawn) {
  const OccupancyGrid building = test::draw_building(1);
  const PreparedMap prepared(building);
  const std::atomic<bool> cancelled{true};
  EXPECT_THROW(with_cancellation(cancelled, [&] { const PreparedMap another(building); }), Cancelled);
  EXPECT_THROW(with_cancellation(cancelled, [&] { DrawnWalls::of(prepared, 0.1); }), Cancelled);
  EXPECT_EQ(DrawnWalls::of(prepared, 0.1).cell, 0.1);  // another time it is drawn
}

TEST(Match, TellsOfNoProgressOnceItIsCancelled) {
  const PreparedMap fixed(test::map_part(test::draw_building(1), {0.0, 0.0, 9.0, 9.0}, {}));
  const PreparedMap moving(test::map_part(test::draw_building(1), {7.0, 4.0, 16.0, 13.0}, {}));
  std::atomic<bool> cancelled{false};
  int told = 0, last = 0;
  MatchOptions options;
  options.accept_probability = 1.0;  // so that there is a thorough look too
  options.progress = [&](double) {
    if (++told == last) cancelled = true;
  };
  const auto work = [&] { with_threads(1, [&] { match(fixed, moving, options); }); };
  with_cancellation(cancelled, work);
  const int all = told;
  EXPECT_GE(all, 11);
  for (last = 1; last < all; ++last) {
    told = 0;
    cancelled = false;
    EXPECT_THROW(with_cancellation(cancelled, work), Cancelled);
    EXPECT_EQ(told, last);
  }
}

TEST(Match, JoinsPartsThatOverlap) {
  std::mt19937 random(5);
  const OccupancyGrid building = test::draw_building(2);
  const SE2 T_a = random_pose(random);
  const SE2 T_b = random_pose(random);
  const OccupancyGrid a = test::map_part(building, {0.0, 0.0, 12.0, 13.0}, T_a);
  const OccupancyGrid b = test::map_part(building, {5.0, 0.0, 18.0, 13.0}, T_b);
  const MatchResult result = match(a, b);
  EXPECT_EQ(result.verdict, Verdict::accepted);
  expect_near(result.T_fixed_moving, T_a * inverse(T_b), 0.4, 1.0 * kDegree);
  EXPECT_GT(result.overlap, 0.4);
  EXPECT_GT(result.acceptance_index, 0.9);
  EXPECT_EQ(result.hypotheses.front().T_fixed_moving, result.T_fixed_moving);
  EXPECT_EQ(result.hypotheses.front().probability, result.probability);
}

TEST(Match, TheOtherWayRoundIsTheInverse) {
  std::mt19937 random(6);
  const OccupancyGrid building = test::draw_building(3);
  const OccupancyGrid a = test::map_part(building, {0.0, 0.0, 13.0, 13.0}, random_pose(random));
  const OccupancyGrid b = test::map_part(building, {4.0, 0.0, 18.0, 13.0}, random_pose(random));
  const MatchResult forth = match(a, b);
  const MatchResult back = match(b, a);
  expect_near(back.T_fixed_moving, inverse(forth.T_fixed_moving), 1e-9, 1e-9);
  EXPECT_EQ(forth.verdict, back.verdict);
  EXPECT_EQ(forth.probability, back.probability);
  EXPECT_EQ(forth.agreement, back.agreement);
  EXPECT_EQ(forth.overlap, back.overlap);
}

TEST(Match, RefusesUnrelatedBuildings) {
  for (unsigned seed = 10; seed < 20; ++seed) {
    std::mt19937 random(seed);
    const OccupancyGrid a = test::draw_building(seed);
    const OccupancyGrid b =
        transform_grid(test::draw_building(seed + 100), random_pose(random), a.resolution);
    EXPECT_EQ(match(a, b).verdict, Verdict::refused) << seed;
  }
}

/// Whoever accepts less is told the same probability: all looks are made that the usual threshold asks for.
TEST(Match, WhoAcceptsLessIsToldTheSameProbability) {
  MatchOptions least, quick;
  least.accept_probability = 0.05;
  quick.search = SearchMethod::quick;
  std::size_t changed = 0;  // by the second look, though the first has enough for 0.05
  for (const unsigned seed : {2u, 8u}) {
    const OccupancyGrid building = test::draw_building(seed);
    for (const double right : {5.8, 6.2, 7.0}) {
      const PreparedMap fixed(test::map_part(building, {0.0, 0.0, right, 13.0}, {}));
      const PreparedMap moving(test::map_part(building, {5.0, 0.0, 18.0, 13.0}, {1.0, 2.0, 0.5}));
      const double first = match(fixed, moving, quick).probability;
      const double usual = match(fixed, moving).probability;
      changed += first >= 0.05 && first != usual ? 1 : 0;
      EXPECT_EQ(match(fixed, moving, least).probability, usual)
          << "seed " << seed << ", to " << right << " m";
    }
  }
  EXPECT_GT(changed, 0u) << "or the test says nothing";
}

/// A floor that looks the same from its two ends: a building and, beside it, the same turned by half a turn.
OccupancyGrid symmetric_floor(unsigned seed) {
  const OccupancyGrid half = test::draw_building(seed);
  OccupancyGrid floor = make_grid(2 * half.width, half.height, half.resolution);
  for (int row = 0; row < half.height; ++row) {
    for (int column = 0; column < half.width; ++column) {
      floor.at(column, row) = half.at(column, row);
      floor.at(floor.width - 1 - column, floor.height - 1 - row) = half.at(column, row);
    }
  }
  return floor;
}

TEST(Match, AFloorThatLooksTheSameFromTwoEndsIsAmbiguousAndBothWaysAreGiven) {
  std::mt19937 random(6);
  for (unsigned seed = 1; seed <= 3; ++seed) {
    const OccupancyGrid floor = symmetric_floor(seed);
    const SE2 T_robot_floor = random_pose(random);
    const OccupancyGrid turned = transform_grid(floor, T_robot_floor, floor.resolution);
    const MatchResult result = match(floor, turned);
    EXPECT_EQ(result.verdict, Verdict::refused);
    EXPECT_EQ(result.reason, Reason::ambiguous);
    ASSERT_GE(result.hypotheses.size(), 2U);
    EXPECT_GT(result.hypotheses[1].score, 0.9 * result.hypotheses[0].score);
    const double turn = result.hypotheses[1].T_fixed_moving.theta - result.hypotheses[0].T_fixed_moving.theta;
    EXPECT_NEAR(std::abs(normalize_angle(turn)), std::numbers::pi, 0.02);
    EXPECT_LT(result.probability, 0.9);
  }
}

TEST(Match, SaysWhyItRefuses) {
  const OccupancyGrid building = test::draw_building(2);
  EXPECT_EQ(match(building, building).reason, Reason::none);
  EXPECT_NE(match(building, test::draw_building(3)).reason, Reason::none);
  EXPECT_EQ(match(building, make_grid(20, 20, 0.1)).reason, Reason::nothing_to_compare);
}

TEST(Match, HandlesOtherResolutionsAndYawedOrigins) {
  const OccupancyGrid fine = test::draw_building(1);
  const SE2 T_robot_building{4.0, -3.0, 2.0};
  OccupancyGrid coarse = transform_grid(fine, T_robot_building, 1.6 * fine.resolution);
  const MatchResult upright = match(fine, coarse);
  EXPECT_EQ(upright.verdict, Verdict::accepted);
  expect_near(upright.T_fixed_moving, inverse(T_robot_building), 0.3, 1.0 * kDegree);

  const SE2 T_other_robot{1.0, 2.0, -0.8};  // the same cells in a frame that makes the grid lie askew
  coarse.origin = T_other_robot * coarse.origin;
  const MatchResult askew = match(fine, coarse);
  expect_near(askew.T_fixed_moving, upright.T_fixed_moving * inverse(T_other_robot), 1e-6, 1e-6);
}

TEST(Match, TwoIdenticalMapsLieExactlyOnEachOther) {
  for (const unsigned seed : {1U, 2U, 3U, 4U}) {
    const OccupancyGrid map = test::draw_building(seed);
    const MatchResult result = match(map, map);
    EXPECT_EQ(result.verdict, Verdict::accepted) << seed;
    EXPECT_EQ(result.T_fixed_moving, SE2{}) << seed;
    EXPECT_EQ(result.acceptance_index, 1.0) << seed;
    // But for single cells that count as paint.
    EXPECT_GT(static_cast<double>(result.agreement), 0.999 * static_cast<double>(count_cells(map).known()));
    EXPECT_EQ(result.disagreement, 0) << seed;
    EXPECT_EQ(result.overlap, 1.0) << seed;
  }
}

TEST(Match, DoesNotDependOnThreads) {
  const OccupancyGrid building = test::draw_building(2);
  const OccupancyGrid a = test::map_part(building, {0.0, 0.0, 12.0, 13.0}, {1.0, 2.0, 0.5});
  const OccupancyGrid b = test::map_part(building, {5.0, 0.0, 18.0, 13.0}, {-4.0, 1.0, 2.5});
  MatchOptions options;
  options.threads = 1;
  const MatchResult one = match(a, b, options);
  options.threads = 3;
  const MatchResult three = match(a, b, options);
  ASSERT_EQ(one.hypotheses.size(), three.hypotheses.size());
  for (std::size_t i = 0; i < one.hypotheses.size(); ++i) {
    EXPECT_EQ(one.hypotheses[i].T_fixed_moving, three.hypotheses[i].T_fixed_moving);
    EXPECT_EQ(one.hypotheses[i].score, three.hypotheses[i].score);
  }
  EXPECT_EQ(one.probability, three.probability);
}

TEST(Match, MapsWithNothingToGoByAreRefused) {
  const OccupancyGrid map = test::draw_building(1);
  for (const OccupancyGrid& poor :
       {make_grid(1, 1, 0.05), make_grid(1, 1, 0.05, {}, Cell::occupied), make_grid(30, 30, 0.05),
        make_grid(30, 30, 0.05, {}, Cell::free), make_grid(30, 30, 0.05, {}, Cell::occupied),
        make_grid(400, 1, 0.05, {}, Cell::occupied)}) {
    for (const MatchResult& result : {match(map, poor), match(poor, map), match(poor, poor)}) {
      EXPECT_EQ(result.verdict, Verdict::refused);
      EXPECT_TRUE(std::isfinite(result.T_fixed_moving.x) && std::isfinite(result.probability));
    }
  }
}

TEST(Match, ReportsProgressAndListsNoMoreThanAsked) {
  MatchOptions options;
  options.max_hypotheses = 3;
  double last = 0.0;
  options.progress = [&](double share) {
    EXPECT_GE(share, last);
    last = share;
  };
  const MatchResult result = match(test::draw_building(1), test::draw_building(2), options);
  EXPECT_EQ(last, 1.0);
  EXPECT_LE(result.hypotheses.size(), 3U);
  EXPECT_GT(result.seconds, 0.0);
}

// Two robots that have just started: a corner of a room, and a bare hall crossed once.
TEST(Match, SparseMapsHaveAnAnswer) {
  OccupancyGrid corner = make_grid(100, 100, 0.05, {}, Cell::free);
  for (int i = 0; i < 100; ++i) corner.at(i, 0) = corner.at(0, i) = Cell::occupied;
  OccupancyGrid hall = make_grid(240, 30, 0.05, {}, Cell::free);
  for (const auto& [x, y] : {std::pair{0, 14},
                             {239, 15},
                             {60, 0},
                             {61, 0},
                             {120, 29},
                             {121, 29},
                             {180, 0},
                             {181, 0},
                             {30, 29},
                             {210, 29}})
    hall.at(x, y) = Cell::occupied;
  EXPECT_EQ(match(corner, hall).verdict, Verdict::refused);
  EXPECT_EQ(match(hall, corner).verdict, Verdict::refused);
}

TEST(Match, RefusesInvalidInput) {
  const OccupancyGrid map = test::draw_building(1);
  OccupancyGrid broken = map;
  broken.resolution = -1.0;
  EXPECT_THROW(match(map, broken), std::invalid_argument);
  EXPECT_THROW(match(broken, map), std::invalid_argument);
  MatchOptions options;
  options.threads = -1;
  EXPECT_THROW(match(map, map, options), std::invalid_argument);
  options = {};
  for (const double probability : {std::nan(""), -0.001, 1.001}) {
    options.accept_probability = probability;
    EXPECT_THROW(match(map, map, options), std::invalid_argument);
  }
  for (const double probability : {0.0, 1.0}) {
    options.accept_probability = probability;
    EXPECT_NO_THROW(validate(options));
  }
}

/// What a robot sees of a plain room from `reach` metres around one of its corners, the room turned so that
/// the corner is the lower left one. Walls waver by a cell.
OccupancyGrid corner_of_a_room(double reach, unsigned seed) {
  constexpr double kCell = 0.05;
  const int side = static_cast<int>(reach / kCell);
  OccupancyGrid map = make_grid(side + 10, side + 10, kCell);
  std::mt19937 random(seed);
  for (int y = 5; y < side + 5; ++y) {
    for (int x = 5; x < side + 5; ++x) {
      if (std::hypot(x, y) * kCell < reach) map.at(x, y) = Cell::free;
    }
  }
  for (int i = 5; i < side; ++i) {
    map.at(i, 5 + static_cast<int>(random() % 2)) = Cell::occupied;
    map.at(5 + static_cast<int>(random() % 2), i) = Cell::occupied;
  }
  return map;
}

TEST(Match, DoesNotBelieveInABareCorner) {
  for (unsigned seed = 0; seed < 4; ++seed) {
    const OccupancyGrid a = corner_of_a_room(7.0, seed);
    const OccupancyGrid b =
        transform_grid(corner_of_a_room(6.0 + seed, seed + 100), {3.0, 1.0, 0.5 * seed}, 0.05);
    EXPECT_EQ(match(a, b).verdict, Verdict::refused) << seed;
  }
}

}  // namespace
}  // namespace gridmerge
