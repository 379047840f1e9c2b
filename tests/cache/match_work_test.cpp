// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <atomic>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "gridmerge/cache/match_cache.hpp"
#include "gridmerge/grid/execution.hpp"
#include "gridmerge/io/file_error.hpp"
#include "merge/team.hpp"

namespace gridmerge {

using test::expect_same;
using test::Team;

namespace {

class MatchWorkTest : public testing::Test {
 protected:
  MatchWork work(std::size_t index, std::size_t count) {
    Merger merger = filled();
    MatchCache cache(directory.file("matches"));
    MatchWorkOptions options;
    options.shard = {index, count};
    return match_with_cache(merger, cache, options);
  }

  Merger filled(const MergeOptions& options = {}) {
    Merger merger(options);
    for (const OccupancyGrid& map : team.maps) merger.add(map);
    return merger;
  }

  const Team team;
  const test::TemporaryDirectory directory;
};

TEST_F(MatchWorkTest, ShardsMakeEachMatchOnceAndTheMergeIsThatOfOneMachine) {
  // Each has ten pairs in the first round and the stranger's four in the second.
  std::size_t made = 0;
  for (std::size_t shard = 0; shard < 3; ++shard) {
    const MatchWork first = work(shard, 3);
    made += first.made;
    EXPECT_EQ(first.missing > 0, true);  // the second round waits for others
  }
  for (std::size_t shard = 0; shard < 3; ++shard) made += work(shard, 3).made;
  EXPECT_EQ(made, 14u);
  std::size_t matched = 0;
  MergeOptions options;
  options.progress = [&](std::size_t, std::size_t) { ++matched; };
  Merger merger = filled(options);
  MatchCache cache(directory.file("matches"));
  const MatchWork last = match_with_cache(merger, cache);
  EXPECT_EQ(last.found, 14u);
  EXPECT_EQ(last.made, 0u);
  EXPECT_EQ(last.missing, 0u);
  expect_same(merger.solve(), merge(team.maps));
  EXPECT_EQ(matched, 0u);
}

TEST_F(MatchWorkTest, TellsHowManyOfARoundAreThere) {
  using Told = std::vector<std::pair<std::size_t, std::size_t>>;
  const auto told_by = [&] {
    Told told;
    MergeOptions one_thread;
    one_thread.match.threads = 1;
    Merger merger = filled(one_thread);
    MatchCache cache(directory.file("matches"));
    MatchWorkOptions options;
    options.progress = [&](std::size_t done, std::size_t total) { told.emplace_back(done, total); };
    match_with_cache(merger, cache, options);
    return told;
  };
  // Ten pairs, and then the four of the stranger: what is found, and each that is made.
  Told expected;
  for (const std::size_t total : {10u, 4u}) {
    for (std::size_t done = 0; done <= total; ++done) expected.emplace_back(done, total);
  }
  EXPECT_EQ(told_by(), expected);
  EXPECT_EQ(told_by(), (Told{{10, 10}, {4, 4}}));
}

TEST_F(MatchWorkTest, AShardMakesEveryCountthMatch) {
  const MatchWork first = work(1, 4);  // of ten the second, sixth and tenth
  EXPECT_EQ(first.made, 3u);
  EXPECT_EQ(first.found, 0u);
  EXPECT_EQ(first.missing, 7u);
  const MatchWork again = work(1, 4);  // of the rest there is none for it
  EXPECT_EQ(again.made, 0u);
  EXPECT_EQ(again.found, 3u);
  EXPECT_EQ(again.missing, 7u);
  const MatchWork last = work(3, 4);
  EXPECT_EQ(last.made, 2u);
  EXPECT_EQ(last.found, 3u);
  EXPECT_EQ(last.missing, 5u);
}

TEST_F(MatchWorkTest, GoesOnWhereItWasCancelled) {
  std::atomic<bool> cancelled = false;
  MergeOptions one_thread;
  one_thread.match.threads = 1;
  Merger merger = filled(one_thread);
  MatchCache cache(directory.file("matches"));
  MatchWorkOptions options;
  options.progress = [&](std::size_t done, std::size_t) { cancelled = done == 4; };
  EXPECT_THROW(with_cancellation(cancelled, [&] { match_with_cache(merger, cache, options); }), Cancelled);
  Merger again = filled();
  const MatchWork rest = match_with_cache(again, cache);
  EXPECT_GE(rest.found, 4u);
  EXPECT_EQ(rest.found + rest.made, 14u);
  expect_same(again.solve(), merge(team.maps));
}

TEST_F(MatchWorkTest, OtherOptionsAndMapsFindNothing) {
  EXPECT_EQ(work(0, 1).made, 14u);
  MergeOptions options;
  options.match.accept_probability = 0.9;
  Merger merger = filled(options);
  MatchCache cache(directory.file("matches"));
  EXPECT_EQ(match_with_cache(merger, cache).found, 0u);
}

TEST_F(MatchWorkTest, KeepsMatchesByWhatTheMapsAreNow) {
  const std::vector<OccupancyGrid> maps(team.maps.begin(), team.maps.begin() + 3);
  OccupancyGrid moved = maps[0];  // its robot has started anew, in another frame
  moved.origin = SE2{5, 3, 1} * moved.origin;
  MatchCache cache(directory.file("matches"));
  Merger updated(maps);
  updated.update(updated.maps()[0], moved);
  EXPECT_EQ(match_with_cache(updated, cache).made, 3u);
  Merger fresh(maps);
  const MatchWork work = match_with_cache(fresh, cache);
  EXPECT_EQ(work.made, 2u) << "the pairs of the map before";
  EXPECT_EQ(work.found, 1u);
  expect_same(fresh.solve(), merge(maps));
}

TEST_F(MatchWorkTest, KeepsMatchesOfAMapThatHasGrownAsThoseOfTheNewMap) {
  const OccupancyGrid building = test::draw_building(1);
  const OccupancyGrid grown = test::map_part(building, {0, 0, 12, 13}, team.T_map_building[0]);
  MatchCache cache(directory.file("matches"));
  Merger merger({team.maps[0]});
  merger.grow(merger.maps()[0], grown);
  merger.add(team.maps[1]);
  EXPECT_EQ(match_with_cache(merger, cache).made, 1u);
  Merger before({team.maps[0], team.maps[1]});
  EXPECT_EQ(match_with_cache(before, cache).found, 0u);
  Merger after({grown, team.maps[1]});
  EXPECT_EQ(match_with_cache(after, cache).found, 1u);
}

TEST_F(MatchWorkTest, RefusesWhatMakesNoSense) {
  Merger merger = filled();
  MatchCache cache(directory.file("matches"));
  MatchWorkOptions options;
  for (const Shard& none : {Shard{2, 2}, Shard{0, 0}, Shard{0, kMostShards + 1}}) {
    options.shard = none;
    EXPECT_THROW(match_with_cache(merger, cache, options), std::invalid_argument);
  }
}

TEST_F(MatchWorkTest, WhatCannotBeKeptIsMadeAllTheSameIfThatIsAskedFor) {
  std::vector<std::string> warned;
  MatchCache cache(directory.file("matches"), [&](const std::string& line) { warned.push_back(line); });
  std::filesystem::remove_all(directory.file("matches"));
  directory.write("matches", "a file now");
  Merger merger = filled();
  EXPECT_EQ(match_with_cache(merger, cache).made, 14u);
  EXPECT_EQ(warned.size(), 1u);
  expect_same(merger.solve(), merge(team.maps));
  Merger another = filled();
  MatchWorkOptions options;
  options.goes_on_when_full = false;
  EXPECT_THROW(match_with_cache(another, cache, options), FileError);
}

TEST_F(MatchWorkTest, MatchesThatCannotBeKeptAreToldOnce) {
  std::vector<std::string> warned;
  MatchCache cache(directory.file("matches"), [&](const std::string& line) { warned.push_back(line); });
  MergeOptions quick;
  quick.match.search = SearchMethod::quick;
  const std::vector<OccupancyGrid> maps(team.maps.begin(), team.maps.begin() + 3);
  Merger merger(maps, quick);
  MatchWorkOptions options;
  options.progress = [&](std::size_t done, std::size_t) {  // the folder is lost when the work has begun
    if (done > 0) return;
    EXPECT_TRUE(warned.empty());
    std::filesystem::remove_all(directory.file("matches"));
    directory.write("matches", "a file now");
  };
  EXPECT_EQ(match_with_cache(merger, cache, options).made, 3u);
  ASSERT_EQ(warned.size(), 1u);
  EXPECT_NE(warned[0].find("matches that cannot be kept are made all the same"), std::string::npos)
      << warned[0];
}

}  // namespace
}  // namespace gridmerge
