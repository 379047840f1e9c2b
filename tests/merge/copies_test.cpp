// SPDX-License-Identifier: Apache-2.0
#include "merge/copies.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "../similarity/random_grid.hpp"
#include "grid/quarter_turned.hpp"
#include "merge/joins.hpp"

namespace gridmerge::internal {
namespace {

using Places = std::vector<std::size_t>;

OccupancyGrid some_map(unsigned seed, const SE2& origin = {}) {
  OccupancyGrid map = test::random_grid(seed, 30, 20);
  map.origin = origin;
  return map;
}

TEST(Copies, HoldTheSameCellsAndHaveWalls) {
  const PreparedMap map(some_map(1)), moved(some_map(1, {3.0, -2.0, 0.7})), other(some_map(2));
  EXPECT_TRUE(is_copy(map, map));
  EXPECT_TRUE(is_copy(map, moved)) << "where its frame lies does not matter";
  EXPECT_FALSE(is_copy(map, other));
  OccupancyGrid changed = some_map(1);
  const auto wall = std::find(changed.cells.begin(), changed.cells.end(), Cell::occupied),
             floor_cell = std::find(changed.cells.begin(), changed.cells.end(), Cell::free);
  std::swap(*wall, *floor_cell);
  EXPECT_FALSE(is_copy(map, PreparedMap(changed))) << "as many cells of each kind, elsewhere";
  const OccupancyGrid floor = make_grid(10, 10, 0.1, {}, Cell::free);
  EXPECT_FALSE(is_copy(PreparedMap(floor), PreparedMap(floor))) << "nothing tells floors apart";
}

TEST(Copies, AreOneMapGivenTwiceIfTheCellsSayHowTheyLie) {
  const auto is_twice = [](const OccupancyGrid& a, const OccupancyGrid& b) {
    const PreparedMap prepared_a(a), prepared_b(b);
    return is_given_twice({a, prepared_a}, {b, prepared_b});
  };
  const OccupancyGrid map = some_map(1, {1.0, 2.0, 3.0});
  OccupancyGrid moved = map;
  moved.origin = {-4.0, 0.5, -2.9};
  EXPECT_TRUE(is_twice(map, moved));
  EXPECT_FALSE(is_twice(map, some_map(2)));
  OccupancyGrid twofold = make_grid(6, 4, 0.1, {0.5, 0.0, 1.0}, Cell::free);
  twofold.at(0, 0) = twofold.at(5, 3) = twofold.at(2, 0) = twofold.at(3, 3) = Cell::occupied;
  for (const int quarters : {1, 2, 3})
    EXPECT_TRUE(is_twice(map, quarter_turned(moved, quarters))) << quarters;
  for (const int quarters : {1, 3})
    EXPECT_FALSE(is_twice(twofold, quarter_turned(twofold, quarters))) << quarters;
  for (const int quarters : {0, 2})
    EXPECT_TRUE(is_twice(twofold, quarter_turned(twofold, quarters))) << "one picture";
}

TEST(Copies, LieWhereTheirCellsLieOnEachOther) {
  const SE2 origin{3.0, -2.0, 0.7}, other_origin{-1.0, 4.0, -0.2};
  const PreparedMap a(some_map(1, origin)), b(some_map(1, other_origin));
  EXPECT_EQ(between_copies(a, a), SE2{});
  const SE2 T_a_b = between_copies(a, b);
  const Point2 in_a = a.known().origin * Point2{1.5, 0.5}, in_b = b.known().origin * Point2{1.5, 0.5};
  EXPECT_NEAR((T_a_b * in_b).x, in_a.x, 1e-12);
  EXPECT_NEAR((T_a_b * in_b).y, in_a.y, 1e-12);
}

TEST(WithoutCopies, OfThoseThatLieOnEachOtherTheFirstStays) {
  const SE2 T{2.0, 1.0, 0.4}, origin{3.0, -2.0, 0.7};
  const PreparedMap map(some_map(1)), copy(some_map(1, origin)), other(some_map(2));
  const SE2 T_copy = T * map.known().origin * inverse(copy.known().origin);
  EXPECT_EQ(without_copies({{&map, T}, {&copy, T_copy}, {&map, T}}), (Places{0}));
  EXPECT_EQ(without_copies({{&map, T}, {&other, T}}), (Places{0, 1})) << "another map in the same place";
  EXPECT_EQ(without_copies({{&other, T}, {&copy, T_copy}, {&map, T}}), (Places{0, 1}));
  EXPECT_EQ(without_copies({{&map, T}, {&copy, T}}), (Places{0, 1})) << "a copy elsewhere";
  EXPECT_TRUE(without_copies({}).empty());
}

TEST(WithoutCopies, TheSamePlaceIsWithinAThousandthOfACell) {
  const PreparedMap map(some_map(1));
  const OccupancyGrid& known = map.known();
  const double cell = known.resolution, side = std::max(known.width, known.height) * cell;
  const auto lies_on_it = [&](const SE2& T) {
    // The pose of the known rectangle's corner, so that a turn does not shift it.
    const SE2 T_corner = known.origin * T * inverse(known.origin);
    return without_copies({{&map, {}}, {&map, T_corner}}).size() == 1;
  };
  EXPECT_TRUE(lies_on_it({0.9e-3 * cell, 0.0, 0.0}));
  EXPECT_FALSE(lies_on_it({1.1e-3 * cell, 0.0, 0.0}));
  EXPECT_TRUE(lies_on_it({0.0, -0.9e-3 * cell, 0.0}));
  EXPECT_FALSE(lies_on_it({0.0, -1.1e-3 * cell, 0.0}));
  EXPECT_TRUE(lies_on_it({0.0, 0.0, 0.9e-3 * cell / side}));
  EXPECT_FALSE(lies_on_it({0.0, 0.0, -1.1e-3 * cell / side}));
  EXPECT_FALSE(lies_on_it({0.6e-3 * cell, 0.0, 0.6e-3 * cell / side})) << "the sum counts";
}

void expect_near(const SE2& found, const SE2& expected) {
  EXPECT_NEAR(found.x, expected.x, 1e-12);
  EXPECT_NEAR(found.y, expected.y, 1e-12);
  EXPECT_NEAR(normalize_angle(found.theta - expected.theta), 0.0, 1e-12);
}

/// In the frame of the copy, as the pose of the match is.
TEST(AddCopies, GivesACopyAllHypothesesOfItsOriginal) {
  const SE2 T_0_1{5.0, -1.0, 0.3}, other_T_0_1{-2.0, 4.0, 2.5}, T_1_2{1.0, 2.0, -0.8};
  const OccupancyGrid map = some_map(1), original = some_map(2);
  MergeResult result;
  MatchResult match;
  match.T_fixed_moving = T_0_1;
  match.hypotheses = {{T_0_1, 1.0, 0.6}, {other_T_0_1, 0.5, 0.3}};
  result.joins = {make_join(0, 1, match)};
  result.left_out = {{0, Reason::several}, {1, Reason::several}};
  add_copies({{2, 1, T_1_2}}, {&map, &original, &original}, std::vector<std::optional<KnownPose>>(3), 0.0,
             result);
  const auto join = std::find_if(result.joins.begin(), result.joins.end(),
                                 [](const Join& one) { return one.fixed == 0 && one.moving == 2; });
  ASSERT_NE(join, result.joins.end());
  expect_near(join->T_fixed_moving, T_0_1 * T_1_2);
  expect_near(join->match.T_fixed_moving, T_0_1 * T_1_2);
  ASSERT_EQ(join->match.hypotheses.size(), 2u);
  expect_near(join->match.hypotheses[0].T_fixed_moving, T_0_1 * T_1_2);
  expect_near(join->match.hypotheses[1].T_fixed_moving, other_T_0_1 * T_1_2);
}

}  // namespace
}  // namespace gridmerge::internal
