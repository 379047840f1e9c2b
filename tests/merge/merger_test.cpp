// SPDX-License-Identifier: Apache-2.0
#include "gridmerge/merge/merger.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include "gridmerge/grid/execution.hpp"
#include "gridmerge/match/stored_match.hpp"
#include "merge/team.hpp"
#include "support/building.hpp"

namespace gridmerge {

using test::expect_same;
using test::Team;

namespace {

/// Options with which each round adds the number of its matches to `totals`.
MergeOptions counting_into(std::vector<std::size_t>& totals) {
  MergeOptions options;
  options.progress = [&totals](std::size_t done, std::size_t total) {
    if (done == total) totals.push_back(total);
  };
  return options;
}

TEST(Merger, OneByOneGivesWhatAllAtOnceGives) {
  const Team team;
  Merger merger;
  for (const OccupancyGrid& map : team.maps) {
    merger.add(map);
    merger.solve();
  }
  expect_same(merger.solve(), merge(team.maps));
}

TEST(Merger, MatchesOnlyWhatHasChanged) {
  const Team team;
  std::vector<std::size_t> totals;
  Merger merger(counting_into(totals));
  const auto first = merger.add(team.maps[0]);
  merger.add(team.maps[1]);
  const auto third = merger.add(team.maps[4]);
  merger.solve();
  merger.solve();
  // Three pairs, and a second look at the two that a stranger is in.
  EXPECT_EQ(totals, (std::vector<std::size_t>{3, 2}));

  merger.update(third, team.maps[2]);  // the robot was elsewhere after all
  expect_same(merger.solve(), merge({team.maps[0], team.maps[1], team.maps[2]}));
  EXPECT_EQ(totals, (std::vector<std::size_t>{3, 2, 2}));

  merger.remove(first);
  expect_same(merger.solve(), merge({team.maps[1], team.maps[2]}));
  EXPECT_EQ(totals.size(), 3u);
  EXPECT_EQ(merger.maps(), (std::vector<Merger::MapId>{1, 2}));
}

TEST(Merger, AMapThatGrowsKeepsItsMatchesUntilItIsSearchedAgain) {
  const Team team;
  std::size_t matched = 0;
  MergeOptions options;
  options.progress = [&](std::size_t, std::size_t) { ++matched; };
  Merger merger(options);
  merger.add(team.maps[0]);
  const auto grows = merger.add(team.maps[1]);
  merger.add(team.maps[2]);
  merger.solve();
  const std::size_t first = matched;
  OccupancyGrid grown = team.maps[1];
  std::fill_n(grown.cells.begin(), grown.cells.size() / 50, Cell::unknown);
  merger.grow(grows, grown);
  const MergeResult followed = merger.solve();
  EXPECT_EQ(matched, first);
  // The maps are the new ones all the same.
  const std::vector<OccupancyGrid> maps{team.maps[0], grown, team.maps[2]};
  ASSERT_EQ(followed.components.size(), 1u);
  std::vector<PlacedMap> placed;
  for (const Member& member : followed.components[0].members)
    placed.push_back({&maps[member.map], member.T_component_map});
  EXPECT_EQ(followed.components[0].fused.grid.cells, fuse(placed, maps[0].resolution).grid.cells);

  merger.search_again(grows);
  expect_same(merger.solve(), merge(maps));
  EXPECT_EQ(matched, first + 2);
  EXPECT_THROW(merger.grow(grows + 7, grown), std::out_of_range);
  EXPECT_THROW(merger.search_again(grows + 7), std::out_of_range);
}

TEST(Merger, TellsWhatItsMapsHoldAsTheyAreNow) {
  const Team team;
  const auto ids = [](const std::vector<OccupancyGrid>& maps) {
    std::vector<std::string> contents;
    for (const OccupancyGrid& map : maps) contents.push_back(content_id(map));
    return contents;
  };
  Merger merger({team.maps[0], team.maps[1], team.maps[2]});
  EXPECT_EQ(merger.contents(), ids({team.maps[0], team.maps[1], team.maps[2]}));
  merger.update(0, team.maps[3]);
  merger.grow(1, team.maps[4]);
  EXPECT_EQ(merger.contents(), ids({team.maps[3], team.maps[4], team.maps[2]}));
  merger.remove(0);
  EXPECT_EQ(merger.contents(), ids({team.maps[4], team.maps[2]}));
}

TEST(Merger, SoonAndBitByBitItIsTheSameInTheEnd) {
  const Team team;
  std::vector<std::size_t> totals;
  Merger merger(counting_into(totals));
  for (const std::size_t map : {0u, 1u, 4u}) merger.add(team.maps[map]);
  merger.solve_soon(0);
  EXPECT_FALSE(merger.is_complete());
  EXPECT_EQ(totals, (std::vector<std::size_t>{3}));
  merger.solve_soon(1);
  EXPECT_FALSE(merger.is_complete());
  const MergeResult result = merger.solve_soon(1);
  EXPECT_TRUE(merger.is_complete());
  EXPECT_EQ(totals, (std::vector<std::size_t>{3, 1, 1}));
  expect_same(result, merge({team.maps[0], team.maps[1], team.maps[4]}));
}

TEST(Merger, WhatWasMatchedBeforeItWasCancelledIsKept) {
  const Team team;
  std::atomic<bool> cancelled = false;
  std::vector<std::size_t> totals;
  MergeOptions options;
  options.match.threads = 1;
  options.progress = [&](std::size_t done, std::size_t total) {
    totals.push_back(total);
    if (done == 2) cancelled = true;
  };
  Merger merger(options);
  for (std::size_t i = 0; i < 4; ++i) merger.add(team.maps[i]);
  EXPECT_THROW(with_cancellation(cancelled, [&] { merger.solve(); }), Cancelled);
  EXPECT_FALSE(merger.is_complete());
  const std::size_t done = totals.size();
  expect_same(merger.solve(), merge({team.maps.begin(), team.maps.begin() + 4}));
  EXPECT_GE(done, 2u);
  EXPECT_EQ(totals.at(done), 6 - done);
}

TEST(Merger, TakesAKnownPoseLater) {
  const OccupancyGrid building = test::draw_building(1);
  const std::vector<OccupancyGrid> maps{test::map_part(building, {0, 0, 8, 13}, {}),
                                        test::map_part(building, {10, 0, 18, 13}, {})};
  const KnownPose first{{5.0, 5.0, 0.0}, 0.1, 0.01}, second{{5.2, 5.0, 0.0}, 0.1, 0.01};
  Merger merger;
  const auto a = merger.add(maps[0]), b = merger.add(maps[1]);
  EXPECT_EQ(merger.solve().left_out.size(), 2u);
  merger.set_known_pose(a, first);
  merger.set_known_pose(b, second);
  expect_same(merger.solve(), merge(maps, {}, {first, second}));
  EXPECT_EQ(merger.solve().components.size(), 1u);
  merger.set_known_pose(b, std::nullopt);
  EXPECT_EQ(merger.solve().left_out.size(), 2u);
  EXPECT_THROW(merger.set_known_pose(b + 7, first), std::out_of_range);
}

TEST(Merger, IsAsItWasAfterAnError) {
  const Team team;
  Merger merger;
  const auto id = merger.add(team.maps[0]);
  OccupancyGrid broken = team.maps[1];
  broken.cells.pop_back();
  EXPECT_THROW(merger.add(broken), std::invalid_argument);
  EXPECT_THROW(merger.update(id, broken), std::invalid_argument);
  EXPECT_THROW(merger.update(id + 7, team.maps[1]), std::out_of_range);
  EXPECT_THROW(merger.remove(id + 7), std::out_of_range);
  EXPECT_THROW(merger.set_known_pose(id, KnownPose{{}, 0.0, 0.0}), std::invalid_argument);
  EXPECT_EQ(merger.maps(), std::vector<Merger::MapId>{id});
  EXPECT_EQ(test::maps_left_out(merger.solve()), std::vector<std::size_t>{0});
}

}  // namespace
}  // namespace gridmerge
