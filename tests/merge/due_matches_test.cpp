// SPDX-License-Identifier: Apache-2.0
// Matches of a merge that are made elsewhere.
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <limits>
#include <optional>
#include <random>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "gridmerge/merge/merge.hpp"
#include "gridmerge/merge/merger.hpp"
#include "merge/team.hpp"

namespace gridmerge {

using test::expect_same;
using test::Team;

namespace {

/// Makes what is due as another machine would, and hands it in in any order. Says how many rounds there were
/// of each search.
std::vector<SearchMethod> match_elsewhere(Merger& merger, const std::vector<OccupancyGrid>& maps,
                                          unsigned seed) {
  std::mt19937 random(seed);
  std::vector<SearchMethod> rounds;
  for (std::vector<DueMatch> due = merger.due(); !due.empty(); due = merger.due()) {
    rounds.push_back(due.front().search);
    std::shuffle(due.begin(), due.end(), random);
    for (const DueMatch& one : due) {
      EXPECT_EQ(one.search, rounds.back());
      merger.hand_in(one, match(maps[one.fixed], maps[one.moving], merger.match_options(one.search)));
    }
  }
  return rounds;
}

void hand_in_first_looks(Merger& merger, const std::vector<OccupancyGrid>& maps) {
  for (std::vector<DueMatch> due = merger.due(); !due.empty() && due.front().search == SearchMethod::quick;
       due = merger.due()) {
    for (const DueMatch& one : due)
      merger.hand_in(one, match(maps[one.fixed], maps[one.moving], merger.match_options(one.search)));
  }
}

/// Options of a merge that counts the pairs which it matches itself.
MergeOptions counting(std::size_t& matched) {
  MergeOptions options;
  options.progress = [&](std::size_t, std::size_t) { ++matched; };
  return options;
}

TEST(DueMatches, MadeElsewhereTheyLeaveNothingToBeMatched) {
  const Team team;
  const MergeResult expected = merge(team.maps);
  for (const unsigned seed : {1u, 2u}) {
    std::size_t matched = 0;
    Merger merger(counting(matched));
    for (const OccupancyGrid& map : team.maps) merger.add(map);
    EXPECT_EQ(match_elsewhere(merger, team.maps, seed),
              (std::vector{SearchMethod::quick, SearchMethod::exhaustive}));
    expect_same(merger.solve(), expected);
    EXPECT_EQ(matched, 0u);
    EXPECT_TRUE(merger.is_complete());
    EXPECT_TRUE(merger.due().empty());
  }
}

TEST(DueMatches, OtherSearchesHaveOneRound) {
  const Team team;
  MergeOptions options;
  options.match.search = SearchMethod::quick;
  Merger merger(options);
  for (const OccupancyGrid& map : team.maps) merger.add(map);
  EXPECT_EQ(match_elsewhere(merger, team.maps, 1), std::vector{SearchMethod::quick});
  expect_same(merger.solve(), merge(team.maps, options));
}

TEST(DueMatches, AreThoseThatSolveWouldMake) {
  const Team team;
  std::size_t matched = 0;
  Merger merger(counting(matched));
  for (const OccupancyGrid& map : team.maps) merger.add(map);
  const std::vector<DueMatch> due = merger.due();
  EXPECT_EQ(due.size(), 10u);
  std::set<std::pair<std::size_t, std::size_t>> pairs;
  for (const DueMatch& one : due) pairs.insert(std::minmax(one.fixed, one.moving));
  EXPECT_EQ(pairs.size(), 10u);
  // Half of them made elsewhere, the rest here.
  for (std::size_t i = 0; i < 5; ++i)
    merger.hand_in(due[i], match(team.maps[due[i].fixed], team.maps[due[i].moving],
                                 merger.match_options(due[i].search)));
  EXPECT_EQ(merger.due().size(), 5u);
  expect_same(merger.solve(), merge(team.maps));
  EXPECT_EQ(matched, 5u + 4u);  // and the stranger with each of the others again
}

TEST(DueMatches, OfAMapThatHasChangedAreDueAgain) {
  Team team;
  Merger merger;
  for (const OccupancyGrid& map : team.maps) merger.add(map);
  match_elsewhere(merger, team.maps, 1);
  team.maps[3] = team.maps[1];
  merger.update(3, team.maps[3]);  // a copy now, which counts once
  EXPECT_TRUE(merger.due().empty());
  merger.search_again(1);
  EXPECT_EQ(merger.due().size(), 3u);
  match_elsewhere(merger, team.maps, 2);
  expect_same(merger.solve(), merge(team.maps));
}

TEST(DueMatches, SecondLooksGoOnFromTheFirstLooksOfTheMapsAsTheyAre) {
  Team team;
  Merger merger;
  for (const OccupancyGrid& map : team.maps) merger.add(map);
  merger.solve();
  const OccupancyGrid stranger = test::draw_building(77);
  team.maps[1] = stranger;  // it was joined by a first look alone
  merger.update(1, stranger);
  hand_in_first_looks(merger, team.maps);
  expect_same(merger.solve(), merge(team.maps));
}

TEST(DueMatches, SecondLooksDoNotGoOnFromFirstLooksOfMapsThatHaveGrown) {
  const OccupancyGrid whole = test::draw_building(1), other = test::draw_building(2);
  Merger merger;
  merger.add(other);
  merger.add(test::map_part(whole, {0, 0, 9, 9}, {}));  // the smaller one, and the larger one from here on
  merger.solve_soon(0);
  OccupancyGrid grown = make_grid(whole.width + 40, whole.height + 40, whole.resolution, {}, Cell::free);
  for (int row = 0; row < whole.height; ++row) {
    for (int column = 0; column < whole.width; ++column) grown.at(column, row) = whole.at(column, row);
  }
  merger.grow(1, grown);
  const MergeResult result = merger.solve();
  const MatchResult expected = match(other, grown);
  ASSERT_EQ(result.joins.size(), 1u);
  EXPECT_EQ(result.joins[0].match.probability, expected.probability);
  EXPECT_EQ(result.joins[0].match.T_fixed_moving, expected.T_fixed_moving);
}

TEST(DueMatches, StoresOfComparisonsThatMakeNoSenseAreRefused) {
  Merger merger;
  ComparisonStore store;
  store.begin = 1.0;
  EXPECT_THROW(merger.keep_comparisons(store), std::invalid_argument);
  store.begin = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(merger.keep_comparisons(store), std::invalid_argument);
  store.begin = 0.5;
  store.find = [](const std::string&) { return std::nullopt; };
  EXPECT_THROW(merger.keep_comparisons(store), std::invalid_argument);
  store.keep = [](const std::string&, const std::vector<float>&) {};
  EXPECT_FALSE(merger.keep_comparisons(store).find);
  EXPECT_EQ(merger.keep_comparisons({}).begin, 0.5) << "it gives the store before";
}

TEST(DueMatches, WhatIsKnownLaterChangesWhatIsDue) {
  const Team team;
  Merger merger;
  for (const OccupancyGrid& map : team.maps) merger.add(map);
  hand_in_first_looks(merger, team.maps);
  EXPECT_EQ(merger.due().size(), 4u);  // of the stranger
  for (std::size_t map = 0; map < 5; ++map) merger.set_known_pose(map, KnownPose{{0, 0, 0}, 0.1, 0.1, true});
  EXPECT_TRUE(merger.due().empty());  // all are fixed, so none lies apart
  merger.remove(4);
  EXPECT_TRUE(merger.due().empty());
  EXPECT_EQ(merger.solve().components.at(0).members.size(), 4u);
}

TEST(DueMatches, RefuseWhatNobodyAskedFor) {
  const Team team;
  Merger merger;
  EXPECT_TRUE(merger.due().empty());
  merger.add(team.maps[0]);
  EXPECT_TRUE(merger.due().empty());
  EXPECT_TRUE(merger.due().empty());
  merger.add(team.maps[1]);
  EXPECT_THROW(merger.hand_in({0, 2, SearchMethod::quick}, {}), std::out_of_range);
  EXPECT_THROW(merger.hand_in({2, 0, SearchMethod::quick}, {}), std::out_of_range);
  EXPECT_THROW(merger.hand_in({1, 1, SearchMethod::quick}, {}), std::invalid_argument);
  EXPECT_THROW(merger.hand_in({0, 1, SearchMethod::thorough}, {}), std::invalid_argument);
  EXPECT_EQ(merger.due().size(), 1u);
}

TEST(DueMatches, OfPosesTooFarApartTheMergeSaysWhatIsWrong) {
  const Team team;
  Merger merger({team.maps[0], team.maps[1], team.maps[4]});
  for (std::vector<DueMatch> due = merger.due(); !due.empty(); due = merger.due()) {
    for (const DueMatch& one : due) {
      MatchResult match = merger.make(one);
      for (Hypothesis& hypothesis : match.hypotheses) hypothesis.T_fixed_moving.x = 1e12;
      merger.hand_in(one, match);
    }
  }
  try {
    merger.solve();
    FAIL() << "merged";
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("would exceed 2^28 cells"), std::string::npos) << error.what();
  }
}

TEST(DueMatches, RefuseMatchesThatNoSearchCanHaveFound) {
  const Team team;
  Merger merger({team.maps[0], team.maps[1]});
  const DueMatch due = merger.due().at(0);
  const MatchResult sound = merger.make(due);
  ASSERT_GT(sound.hypotheses.at(0).probability, 0.5);
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  const std::vector<std::function<void(MatchResult&)>> flaws{
      [](MatchResult& match) { match.probability = kNaN; },
      [](MatchResult& match) { match.probability = 2.0; },
      [](MatchResult& match) { match.hypotheses[0].probability = -1.0; },
      [](MatchResult& match) { match.T_fixed_moving.x = kNaN; },
      [](MatchResult& match) { match.hypotheses[0].T_fixed_moving.y = 1e300; },
      [](MatchResult& match) { match.hypotheses[0].figures.held = kNaN; },
      [](MatchResult& match) { match.hypotheses[0].figures.sigma = 0.0; },
      [](MatchResult& match) { match.hypotheses[0].figures.sigma = 1e-300; },
      [](MatchResult& match) { match.hypotheses[0].figures.sigma = 1e300; },
      [](MatchResult& match) { match.overlap = -1.0; },
      [](MatchResult& match) { match.scale = 0.0; },
      [](MatchResult& match) { match.reason = static_cast<Reason>(77); }};
  for (std::size_t i = 0; i < flaws.size(); ++i) {
    MatchResult bad = sound;
    flaws[i](bad);
    EXPECT_THROW(merger.hand_in(due, bad), std::invalid_argument) << i;
    EXPECT_EQ(merger.due().size(), 1u) << i;
  }
  merger.hand_in(due, sound);
  EXPECT_TRUE(merger.due().empty());
}

}  // namespace
}  // namespace gridmerge
