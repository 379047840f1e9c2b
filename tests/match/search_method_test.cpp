// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "gridmerge/match/match.hpp"
#include "gridmerge/match/stored_match.hpp"
#include "gridmerge/simulate/simulate.hpp"
#include "match/looked_twice.hpp"
#include "support/building.hpp"

namespace gridmerge {
namespace {

TEST(SearchMethod, NamesGoBothWays) {
  std::set<std::string> names;
  for (const SearchMethodName& one : search_methods()) {
    EXPECT_TRUE(names.insert(one.name).second) << one.name;
    EXPECT_STRNE(one.meaning, "");
    EXPECT_STREQ(name_of(one.method), one.name);
    EXPECT_EQ(search_method(one.name), one.method);
  }
  EXPECT_EQ(search_method("fast"), std::nullopt);
  EXPECT_EQ(search_method(""), std::nullopt);
}

MatchResult look(const OccupancyGrid& fixed, const OccupancyGrid& moving, SearchMethod search) {
  MatchOptions options;
  options.search = search;
  options.max_hypotheses = std::numeric_limits<std::size_t>::max();
  return match(fixed, moving, options);
}

TEST(SearchMethod, WhatTheQuickLookDecidesIsNotLookedAtAgain) {
  const OccupancyGrid building = test::draw_building(1);
  const OccupancyGrid left = test::map_part(building, {0, 0, 12, 13}, {1.0, 2.0, 0.5});
  const OccupancyGrid right = test::map_part(building, {5, 0, 18, 13}, {});
  const MatchResult quick = look(right, left, SearchMethod::quick);
  const MatchResult both = look(right, left, SearchMethod::exhaustive);
  ASSERT_EQ(quick.verdict, Verdict::accepted);
  EXPECT_EQ(both.T_fixed_moving, quick.T_fixed_moving);
  EXPECT_EQ(both.probability, quick.probability);
  EXPECT_EQ(both.hypotheses.size(), quick.hypotheses.size());
}

TEST(SearchMethod, WhatItLeavesUndecidedIs) {
  const OccupancyGrid one = test::draw_building(1), other = test::draw_building(2);
  const MatchResult quick = look(one, other, SearchMethod::quick);
  const MatchResult both = look(one, other, SearchMethod::exhaustive);
  EXPECT_EQ(both.verdict, Verdict::refused);
  EXPECT_GT(both.hypotheses.size(), quick.hypotheses.size());
}

using internal::match_again;
using internal::match_if_promising;
using internal::match_quickly;
using internal::QuickMatch;

TEST(SearchMethod, ASecondLookGoesOnWhereTheQuickOneEnded) {
  const OccupancyGrid building = test::draw_building(1);
  const PreparedMap larger(test::draw_building(2)),
      smaller(test::map_part(building, {0, 0, 12, 13}, {1, 2, 0.5}));
  for (const auto& [fixed, moving] : {std::pair(&larger, &smaller), std::pair(&smaller, &larger)}) {
    MatchOptions options;
    options.max_hypotheses = 3;  // of more that the quick look has found
    QuickMatch quick = match_quickly(*fixed, *moving, options);
    MatchResult whole = match(*fixed, *moving, options);
    MatchResult again = match_again(*fixed, *moving, options, quick.found);
    options.search = SearchMethod::quick;
    MatchResult look = match(*fixed, *moving, options);
    for (MatchResult* one : {&quick.result, &whole, &again, &look}) {
      EXPECT_GT(one->seconds, 0.0);
      one->seconds = 0.0;
    }
    EXPECT_EQ(to_bytes(again), to_bytes(whole));
    EXPECT_EQ(to_bytes(quick.result), to_bytes(look));
    EXPECT_NE(to_bytes(quick.result), to_bytes(whole));
    EXPECT_GT(quick.found.size(), 3U);
  }
}

TEST(SearchMethod, ASecondLookTakesTheFirstOnesWord) {
  const PreparedMap one(test::draw_building(1)), other(test::draw_building(2));
  internal::QuickLook found = match_quickly(one, other, {}).found;
  ASSERT_FALSE(found.empty());
  EXPECT_EQ(match_again(one, other, {}, found).verdict, Verdict::refused);
  found.front().probability = 0.99;
  EXPECT_EQ(match_again(one, other, {}, found).probability, 0.99);
}

TEST(SearchMethod, APromisingQuickLookIsFollowedByAThoroughOne) {
  const PreparedMap one(test::draw_building(1)), other(test::draw_building(2));
  MatchResult quick = match_quickly(one, other, {}).result, whole = match(one, other);
  ASSERT_EQ(quick.verdict, Verdict::refused);
  ASSERT_GT(quick.probability, 0.0);
  quick.seconds = whole.seconds = 0.0;
  ASSERT_NE(to_bytes(quick), to_bytes(whole));
  const auto look = [&](double from) {
    MatchResult result = match_if_promising(one, other, {}, from);
    result.seconds = 0.0;
    return to_bytes(result);
  };
  EXPECT_EQ(look(quick.probability), to_bytes(whole));
  EXPECT_EQ(look(std::nextafter(quick.probability, 1.0)), to_bytes(quick));

  MatchResult same = match_if_promising(one, one, {}, 0.0), plain = match(one, one);
  ASSERT_EQ(plain.verdict, Verdict::accepted);
  same.seconds = plain.seconds = 0.0;
  EXPECT_EQ(to_bytes(same), to_bytes(plain));

  MatchOptions easy;  // whoever accepts less is told the same probability
  easy.accept_probability = quick.probability;
  ASSERT_EQ(match_quickly(one, other, easy).result.verdict, Verdict::accepted);
  MatchResult believed = match_if_promising(one, other, easy, 0.0);
  EXPECT_EQ(believed.probability, match(one, other, easy).probability);
  EXPECT_NE(believed.probability, quick.probability);
}

TEST(SearchMethod, TheThoroughLookFindsWhatTheQuickOneFinds) {
  const OccupancyGrid building = test::draw_building(1);
  const SE2 T_left_building{1.0, 2.0, 0.5};
  const OccupancyGrid left = test::map_part(building, {0, 0, 12, 13}, T_left_building);
  const OccupancyGrid right = test::map_part(building, {5, 0, 18, 13}, {});
  const MatchResult result = look(right, left, SearchMethod::thorough);
  EXPECT_EQ(result.verdict, Verdict::accepted);
  const Point2 middle = result.T_fixed_moving * (T_left_building * Point2{9.0, 6.5});
  EXPECT_NEAR(middle.x, 9.0, 0.1);
  EXPECT_NEAR(middle.y, 6.5, 0.1);
}

/// Whether the best hypothesis lies where the maps belong. Two maps of one office share a tenth of the floor:
/// walls of 10 to 20 m.
bool finds_what_little_is_shared_of(std::uint64_t seed) {
  SimulateOptions options;
  options.width = 40.0;
  options.height = 25.0;
  options.robots = 2;
  options.overlap = 0.1;
  options.drift = 0.3;
  options.seed = seed;
  const Simulation made = simulate(options);
  const SimulatedPair& pair = made.pairs.at(0);
  const OccupancyGrid& moving = made.maps[pair.moving].grid;
  const MatchResult result = match(made.maps[pair.fixed].grid, moving);
  const Point2 middle =
      moving.origin * Point2{0.5 * moving.width * moving.resolution, 0.5 * moving.height * moving.resolution};
  const Point2 there = result.T_fixed_moving * middle, truly = pair.T_fixed_moving * middle;
  return std::hypot(there.x - truly.x, there.y - truly.y) < 1.0 &&
         std::abs(normalize_angle(result.T_fixed_moving.theta - pair.T_fixed_moving.theta)) < 0.1;
}

TEST(SearchMethod, OfPairsThatShareATenthAThoroughLookFindsSome) {
  int found = 0;
  for (std::uint64_t seed = 50013; seed <= 50024; ++seed)
    found += finds_what_little_is_shared_of(seed) ? 1 : 0;
  EXPECT_GE(found, 2);  // it is 3, and was 0 when the ranking did not count the area that contradicts
}

TEST(SearchMethod, TheRandomWalkIsMatchByRandomWalk) {
  const OccupancyGrid building = test::draw_building(1);
  const OccupancyGrid left = test::map_part(building, {0, 0, 12, 13}, {1.0, 2.0, 0.1});
  MatchOptions options;
  options.search = SearchMethod::random_walk;
  options.random_walk.walk.max_proposals = 300;
  options.random_walk.restarts = 2;
  options.max_hypotheses = 1;
  std::vector<double> told;
  options.progress = [&](double share) { told.push_back(share); };
  const MatchResult result = match(building, left, options);
  RandomWalkMatchOptions walk = options.random_walk;
  walk.max_hypotheses = 1;
  const MatchResult expected = match_by_random_walk(building, left, walk);
  EXPECT_EQ(result.T_fixed_moving, expected.T_fixed_moving);
  EXPECT_EQ(result.acceptance_index, expected.acceptance_index);
  EXPECT_EQ(result.hypotheses.size(), 1U);
  EXPECT_EQ(told, (std::vector<double>{0.5, 1.0}));
}

TEST(SearchMethod, TheRandomWalkChecksItsOptions) {
  const OccupancyGrid map = test::draw_building(1);
  MatchOptions options;
  options.search = SearchMethod::random_walk;
  options.random_walk.restarts = 0;
  EXPECT_THROW(match(map, map, options), std::invalid_argument);
  EXPECT_THROW(validate(options), std::invalid_argument);
  options.search = SearchMethod::quick;  // which takes no notice of them
  EXPECT_NO_THROW(validate(options));
}

TEST(SearchMethod, PreparedMapsAreNeitherWalkedNorScaled) {
  const PreparedMap map(test::draw_building(1));
  MatchOptions walk;
  walk.search = SearchMethod::random_walk;
  EXPECT_THROW(match(map, map, walk), std::invalid_argument);
  MatchOptions scaled;
  scaled.scales = ScaleRange{0.5, 2.0};
  EXPECT_THROW(match(map, map, scaled), std::invalid_argument);
}

TEST(SearchMethod, OthersThanThereAreAreRefused) {
  MatchOptions options;
  options.search = static_cast<SearchMethod>(77);
  EXPECT_THROW(validate(options), std::invalid_argument);
}

TEST(SearchMethod, HowManyAreListedChangesNothingElse) {
  const OccupancyGrid one = test::draw_building(1), other = test::draw_building(2);
  MatchOptions options;
  options.max_hypotheses = 1;
  const MatchResult few = match(one, other, options);
  const MatchResult all = look(one, other, SearchMethod::exhaustive);
  ASSERT_EQ(few.hypotheses.size(), 1U);
  EXPECT_EQ(few.probability, all.probability);
  EXPECT_EQ(few.T_fixed_moving, all.T_fixed_moving);
}

}  // namespace
}  // namespace gridmerge
