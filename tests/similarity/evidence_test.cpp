// SPDX-License-Identifier: Apache-2.0
#include "similarity/evidence.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "random_grid.hpp"

namespace gridmerge {

using namespace internal;
namespace {

constexpr std::size_t kAll = std::numeric_limits<std::size_t>::max();

/// The class of two facings by the angle between them, worked out anew: between two directions, or between
/// the lines on which they lie where one is an axis.
int class_by_angle(std::uint8_t point, std::uint8_t place, double theta) {
  if (point == kNoDirection || place == kNoDirection) return kUnclearFacing;
  const auto parts = [](std::uint8_t facing) { return is_axis(facing) ? facing - kDirections : facing; };
  double between = parts(point) + std::round(theta / (2.0 * std::numbers::pi) * kDirections) - parts(place);
  const bool lines = is_axis(point) || is_axis(place);
  between = std::abs(std::remainder(between, lines ? kAxes : kDirections));
  int facing = 1;
  for (const double up_to : {1.0, 2.0, 3.0, 5.0, 12.0}) facing += between > up_to ? 1 : 0;
  return lines ? std::max(facing, 2) : facing;
}

/// From the least to the most that a score may be: of a wall that lies on the edge of cells, any of these may
/// count, as floats round.
struct Range {
  double low = 0.0, high = 0.0;

  bool holds(double score) const {
    const double rounding = 0.01 + 1e-5 * std::max(std::abs(low), std::abs(high));
    return score > low - rounding && score < high + rounding;
  }
};

/// The sum of the table over every wall point of `points`, looked up in `map` one by one.
Range sum_of_table(const LikelihoodField& map, const LikelihoodField& points, const SE2& T,
                   const ErrorModel& model, double scale = 1.0) {
  const auto table = evidence_table(model, map.background);
  const auto worth = [&](const WallPoint& wall, double at_x, double at_y) {
    const int x = static_cast<int>(std::floor(at_x));
    const int y = static_cast<int>(std::floor(at_y));
    if (x < 0 || y < 0 || x >= map.width || y >= map.height) return 0.0;
    const Place place = map.places[static_cast<std::size_t>(y) * map.width + x];
    if (place.distance == kUnseen) return 0.0;
    return double{table[encounter(place.distance, class_by_angle(wall.facing, place.facing, T.theta))]};
  };
  constexpr double kEdge = 1e-4;  // [cells]
  Range sum;
  for (const WallPoint& wall : points.walls) {
    const Point2 p = T * Point2{scale * wall.position.x, scale * wall.position.y};
    const auto [low, high] =
        std::minmax({worth(wall, p.x - kEdge, p.y - kEdge), worth(wall, p.x + kEdge, p.y - kEdge),
                     worth(wall, p.x - kEdge, p.y + kEdge), worth(wall, p.x + kEdge, p.y + kEdge)});
    sum.low += low;
    sum.high += high;
  }
  return sum;
}

/// Of both maps' walls in the other, under the model that makes most of them.
Range best_sum(const LikelihoodField& fixed, const LikelihoodField& moving, const SE2& T,
               double min_sigma = 0.0, double scale = 1.0) {
  SE2 T_back = inverse(T);  // p_moving = (R^-1 p_fixed - R^-1 t) / scale
  T_back.x /= scale;
  T_back.y /= scale;
  constexpr double kNone = -std::numeric_limits<double>::infinity();
  Range best{kNone, kNone};
  for (const ErrorModel& model : error_models()) {
    if (model.sigma < min_sigma) continue;
    const Range there = sum_of_table(fixed, moving, T, model, scale);
    const Range back = sum_of_table(moving, fixed, T_back, model, 1.0 / scale);
    best.low = std::max(best.low, there.low + back.low);
    best.high = std::max(best.high, there.high + back.high);
  }
  return best;
}

TEST(EvidenceTable, IsTheLogOfTheMixtureOverTheBackground) {
  std::array<double, kDistanceBins> background{};
  background.fill(1.0 / kDistanceBins);
  const auto table = evidence_table({1.0, 0.2}, background);
  const double on_the_wall = 0.8 * std::erf(0.5 / std::numbers::sqrt2) * kDistanceBins;
  const std::array ratios{1.0, 4.8, 2.2, 0.9, 0.36, 0.08, 0.16};  // of the classes of facing
  for (int facing = 0; facing < kFacings; ++facing)
    EXPECT_NEAR(table[encounter(0, facing)], std::log(on_the_wall * ratios[facing] + 0.2), 1e-6) << facing;
  EXPECT_NEAR(table[encounter(kDistanceBins - 1, kUnclearFacing)], std::log(0.2), 1e-6);
}

TEST(EvidenceTable, ExpectsNothingOfUnrelatedMaps) {
  // Under the background the likelihood ratio has the mean 1: chance is never evidence.
  const LikelihoodField map = make_likelihood_field(test::random_grid(5, 60, 50), 0.1);
  for (const ErrorModel& model : error_models()) {
    const auto table = evidence_table(model, map.background);
    double unclear = 0.0;
    for (int bin = 0; bin < kDistanceBins; ++bin)
      unclear += map.background[bin] * std::exp(table[encounter(bin, kUnclearFacing)]);
    EXPECT_NEAR(unclear, 1.0, 1e-5);
  }
}

TEST(FacingClass, FollowsTheAngleBetweenTheFreeSides) {
  const auto facing = [](int parts) { return static_cast<std::uint8_t>(parts); };
  const std::array<int, 17> classes{1, 1, 2, 3, 4, 4, 5, 5, 5, 5, 5, 5, 5, 6, 6, 6, 6};
  for (int difference = 0; difference <= kDirections / 2; ++difference) {
    EXPECT_EQ(facing_class(facing(difference), facing(0)), classes[difference]) << difference;
    EXPECT_EQ(facing_class(facing(0), facing(difference)), classes[difference]) << difference;
    EXPECT_EQ(facing_class(facing((30 + difference) % kDirections), facing(30)), classes[difference]);
  }
  EXPECT_EQ(facing_class(kNoDirection, facing(3)), kUnclearFacing);
  EXPECT_EQ(facing_class(facing(3), kNoDirection), kUnclearFacing);
}

TEST(FacingClass, AWallWithFloorOnBothSidesMeetsThoseAlongIt) {
  const auto axis = [](int parts) { return static_cast<std::uint8_t>(kDirections + parts); };
  EXPECT_EQ(facing_class(axis(5), axis(5)), 2);
  EXPECT_EQ(facing_class(axis(5), std::uint8_t{5}), 2);
  EXPECT_EQ(facing_class(axis(5), std::uint8_t{5 + kAxes}), 2);  // from the other side
  EXPECT_GE(facing_class(axis(5), axis(13)), kFirstContraryFacing);
  EXPECT_GE(facing_class(std::uint8_t{13}, axis(5)), kFirstContraryFacing);
}

TEST(WallEvidence, AWallSeenFromTheOtherSideIsNotTheSameWall) {
  // Two rooms that share a wall: each robot saw it from its own room.
  OccupancyGrid left = make_grid(40, 40, 0.1);
  OccupancyGrid right = make_grid(40, 40, 0.1);
  for (int row = 0; row < 40; ++row) {
    for (int column = 0; column < 20; ++column) {
      left.at(column, row) = Cell::free;
      right.at(39 - column, row) = Cell::free;
    }
    left.at(20, row) = Cell::occupied;
    right.at(20, row) = Cell::occupied;
  }
  const LikelihoodField left_walls = make_likelihood_field(left, 0.1);
  const LikelihoodField right_walls = make_likelihood_field(right, 0.1);
  const SE2 T = inverse(left_walls.T_map_grid) * right_walls.T_map_grid;
  const SE2 T_cells{T.x / 0.1, T.y / 0.1, T.theta};
  const double same_side = WallEvidence(left_walls, left_walls, kAll)({}).score;
  EXPECT_GT(same_side, 100.0);
  EXPECT_LT(WallEvidence(left_walls, right_walls, kAll)(T_cells).score, 0.5 * same_side);
}

TEST(AreaEvidence, SpeaksForAgreementAndAgainstDisagreement) {
  EXPECT_EQ(area_evidence(0.0, 0.0), 0.0);
  EXPECT_GT(area_evidence(970.0, 30.0), 0.0);
  EXPECT_LT(area_evidence(850.0, 150.0), 0.0);
  EXPECT_NEAR(area_evidence(1940.0, 60.0), 2.0 * area_evidence(970.0, 30.0), 1e-9);
}

RC_GTEST_PROP(WallEvidence, IsTheBestModelsSumOverAllWalls, (unsigned seed)) {
  const auto side = [] { return *rc::gen::inRange(20, 45); };
  const LikelihoodField fixed = make_likelihood_field(test::random_grid(seed, side(), side()), 0.1);
  const LikelihoodField moving = make_likelihood_field(test::random_grid(seed + 1, side(), side()), 0.1);
  const double min_sigma = *rc::gen::inRange(0, 76) / 10.0;  // up to the largest there is
  const SE2 T{*rc::gen::inRange(-30, 30) + 0.31, *rc::gen::inRange(-30, 30) + 0.17,
              *rc::gen::inRange(-314, 314) / 100.0};
  RC_ASSERT(
      best_sum(fixed, moving, T, min_sigma).holds(WallEvidence(fixed, moving, kAll)(T, min_sigma).score));
}

RC_GTEST_PROP(WallEvidence, OfAScaleIsTheSumOverWallsThatAreMovedByIt, (unsigned seed)) {
  const auto side = [] { return *rc::gen::inRange(20, 45); };
  const LikelihoodField fixed = make_likelihood_field(test::random_grid(seed, side(), side()), 0.1);
  const LikelihoodField moving = make_likelihood_field(test::random_grid(seed + 1, side(), side()), 0.1);
  const double scale = *rc::gen::inRange(50, 200) / 100.0;
  const SE2 T{*rc::gen::inRange(-30, 30) + 0.31, *rc::gen::inRange(-30, 30) + 0.17,
              *rc::gen::inRange(-314, 314) / 100.0};
  const Range best = best_sum(fixed, moving, T, 0.0, scale);
  RC_ASSERT(best.holds(WallEvidence(fixed, moving, kAll)(T, 0.0, scale).score));
}

RC_GTEST_PROP(WallEvidence, IsTheSameFromEitherSide, (unsigned seed)) {
  const LikelihoodField a = make_likelihood_field(test::random_grid(seed, 40, 30), 0.1);
  const LikelihoodField b = make_likelihood_field(test::random_grid(seed + 1, 25, 35), 0.1);
  const SE2 T{3.21, -1.17, *rc::gen::inRange(-314, 314) / 100.0};
  const Range best = best_sum(a, b, T);
  RC_ASSERT(best.holds(WallEvidence(a, b, kAll)(T).score));
  RC_ASSERT(best.holds(WallEvidence(b, a, kAll)(inverse(T)).score));
}

TEST(WallEvidence, IsZeroWhereTheMapsDoNotMeet) {
  const LikelihoodField map = make_likelihood_field(test::random_grid(7, 40, 30), 0.1);
  for (const SE2& far : {SE2{1000.0, 0.0, 0.0}, SE2{1e300, 0.0, 0.0}, SE2{0.0, -1e12, 1.0}}) {
    const Evidence found = WallEvidence(map, map, kAll)(far);
    EXPECT_EQ(found.score, 0.0);
    EXPECT_EQ(found.seen_walls, 0.0);
  }
}

TEST(WallEvidence, PrefersTheTruePoseAndATightModelForAPerfectCopy) {
  const LikelihoodField map = make_likelihood_field(test::random_grid(7, 60, 50), 0.1);
  const WallEvidence evidence(map, map, kAll);
  const Evidence truth = evidence({});
  EXPECT_EQ(truth.model.sigma, error_models().front().sigma);
  EXPECT_EQ(truth.model.outliers, error_models().front().outliers);
  for (const SE2& off : {SE2{2.0, 0.0, 0.0}, SE2{0.0, -2.0, 0.0}, SE2{0.0, 0.0, 0.1}}) {
    EXPECT_GT(truth.score, evidence(off).score);
  }
}

TEST(WallEvidence, MinSigmaLeavesOutTheTightModels) {
  const LikelihoodField map = make_likelihood_field(test::random_grid(7, 60, 50), 0.1);
  const WallEvidence evidence(map, map, kAll);
  // A perfect copy is explained best by the tightest model that is left.
  for (const ErrorModel& model : error_models()) {
    const Evidence found = evidence({}, model.sigma);
    EXPECT_EQ(found.model.sigma, model.sigma);
    EXPECT_EQ(found.model.outliers, error_models().front().outliers);
  }
  EXPECT_EQ(evidence({}, 1e9).model.sigma, error_models().back().sigma);
}

TEST(WallEvidence, WithOtherPointsIsAsIfMadeWithThem) {
  const LikelihoodField fixed = make_likelihood_field(test::random_grid(7, 60, 50), 0.1);
  const LikelihoodField moving = make_likelihood_field(test::random_grid(8, 45, 55), 0.1);
  for (const std::size_t made_with : {std::size_t{50}, kAll}) {
    const WallEvidence evidence(fixed, moving, made_with);
    for (const std::size_t points : {std::size_t{20}, std::size_t{150}, kAll}) {
      const WallEvidence anew(fixed, moving, points);
      for (const SE2& T : {SE2{}, SE2{3.2, -1.7, 0.4}, SE2{-8.0, 5.0, 2.0}}) {
        EXPECT_EQ(evidence.with_points(points)(T).score, anew(T).score);
        EXPECT_EQ(evidence.with_points(points)(T).seen_walls, anew(T).seen_walls);
      }
    }
  }
}

TEST(WallEvidence, AFewPointsStandForAll) {
  const LikelihoodField map = make_likelihood_field(test::random_grid(7, 200, 200), 0.1);
  const double all = WallEvidence(map, map, kAll)({}).score;
  EXPECT_NEAR(WallEvidence(map, map, 200)({}).score, all, 0.2 * all);
}

RC_GTEST_PROP(WallEvidence, SeenWallsAreThoseOfTheWallsOneByOne, (unsigned seed)) {
  const LikelihoodField fixed = make_likelihood_field(test::random_grid(seed, 40, 30), 0.1);
  const LikelihoodField moving = make_likelihood_field(test::random_grid(seed + 1, 25, 35), 0.1);
  const SE2 T{*rc::gen::inRange(-20, 20) + 0.31, *rc::gen::inRange(-20, 20) + 0.17,
              *rc::gen::inRange(-314, 314) / 100.0};
  double seen = 0.0;
  const auto look_up = [&](const LikelihoodField& map, const LikelihoodField& points,
                           const SE2& T_map_points) {
    for (const WallPoint& wall : points.walls) {
      const Point2 p = T_map_points * wall.position;
      const int x = static_cast<int>(std::floor(p.x)), y = static_cast<int>(std::floor(p.y));
      if (x < 0 || y < 0 || x >= map.width || y >= map.height) continue;
      if (map.places[static_cast<std::size_t>(y) * map.width + x].distance != kUnseen) seen += 1.0;
    }
  };
  look_up(fixed, moving, T);
  look_up(moving, fixed, inverse(T));
  const Evidence evidence = WallEvidence(fixed, moving, kAll)(T);
  const double rounding = 0.01 * seen + 2.0;  // of places on the border of cells
  RC_ASSERT(std::abs(evidence.seen_walls - seen) <= rounding);
}

TEST(DrawEvenly, TakesEveryPointOrSpreadsTheCount) {
  std::vector<WallPoint> points;
  points.reserve(10);
  for (int i = 0; i < 10; ++i) points.push_back({{static_cast<double>(i), 0.0}, kNoDirection});
  EXPECT_EQ(draw_evenly(points, 20).size(), 10U);
  const std::vector<WallPoint> five = draw_evenly(points, 5);
  ASSERT_EQ(five.size(), 5U);
  for (int i = 0; i < 5; ++i) EXPECT_EQ(five[i].position.x, 2.0 * i);
  EXPECT_TRUE(draw_evenly({}, 5).empty());
  EXPECT_TRUE(draw_evenly(points, 0).empty());
}

}  // namespace
}  // namespace gridmerge