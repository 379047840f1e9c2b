// SPDX-License-Identifier: Apache-2.0
// One round of choosing pairs at a time, without matches.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>
#include <set>
#include <utility>
#include <vector>

#include "gridmerge/merge/merge.hpp"
#include "merge/pair_choice.hpp"
#include "support/building.hpp"

namespace gridmerge::internal {
namespace {

using Pair = PairChoice::Pair;

/// A free square with a bar in it, 2 m a side: enough to be a map, and to be told from others.
OccupancyGrid tiny(int number) {
  OccupancyGrid map = make_grid(20, 20, 0.1, {}, Cell::free);
  for (int i = 0; i < 12; ++i) map.at(4 + i % 12, 2 + number % 16) = Cell::occupied;
  map.at(number / 16 % 20, 19) = Cell::occupied;
  return map;
}

struct Choice {
  /// `all` maps, with what is known of the poses of some.
  explicit Choice(const std::vector<std::optional<KnownPose>>& poses, double max_missed = 0.5)
      : choice(max_missed) {
    for (std::size_t i = 0; i < poses.size(); ++i) {
      auto map = std::make_shared<const OccupancyGrid>(tiny(static_cast<int>(i)));
      ids.push_back(store.add(std::make_unique<const MapStore::Input>(std::move(map)), poses[i]));
    }
    choice.prepare(store, ids);
    for (std::size_t i = 0; i < ids.size(); ++i) alone.groups.push_back({{i, {}}});
  }

  std::set<Pair> next(std::size_t round, const std::set<Pair>& chosen = {}) const {
    const std::vector<Pair> pairs = choice.next(round, store, chosen, alone);
    std::set<Pair> different(pairs.begin(), pairs.end());
    EXPECT_EQ(different.size(), pairs.size());
    return different;
  }

  MapStore store;
  std::vector<MapStore::MapId> ids;
  PairChoice choice;
  ConsistentSet alone;  // every map is a group by itself
};

TEST(PairRounds, MapsThatAreKnownToMeetAreLookedAtFirst) {
  // Maps in a row, 3 m apart, whose middles are 1.4 m from their corners: twice both radii are 5.7 m.
  std::vector<std::optional<KnownPose>> poses;
  for (int i = 0; i < 30; ++i) poses.push_back(KnownPose{{3.0 * i, 0.0, 0.0}, 1e-3, 1e-3, false});
  poses.resize(60);
  const Choice sure(poses);
  const std::set<Pair> first = sure.next(0);
  for (std::size_t a = 0; a < 30; ++a) {
    for (std::size_t b = a + 1; b < 30; ++b) {
      if (b - a == 1) {
        EXPECT_TRUE(first.contains({sure.ids[a], sure.ids[b]})) << a;
      }
    }
  }
  // The less is known of where they lie, the more may meet: three standard deviations of the difference.
  for (auto& pose : poses) {
    if (pose) pose->sd_position = 3.0;
  }
  const Choice vague(poses);
  const std::set<Pair> more = vague.next(0);
  for (std::size_t a = 0; a < 30; ++a) {
    for (std::size_t b = a + 1; b < 30 && 3.0 * static_cast<double>(b - a) < 3.0 * 3.0 * std::sqrt(2.0);
         ++b) {
      EXPECT_TRUE(more.contains({vague.ids[a], vague.ids[b]})) << a << ' ' << b;
    }
  }
  // Later rounds do not look at them again, and no round looks at a pair twice.
  for (const Pair& pair : vague.next(1, more)) EXPECT_FALSE(more.contains(pair));
}

TEST(PairRounds, RoundsEndWhenTheRestHidesLittle) {
  const std::vector<std::optional<KnownPose>> poses(60);
  std::size_t last = 0;
  for (const double missed : {0.9, 0.5, 0.3}) {
    const Choice choice(poses, missed);
    std::set<Pair> chosen;
    int rounds = 0;
    while (rounds < 50) {
      const std::set<Pair> next = choice.next(static_cast<std::size_t>(rounds), chosen);
      if (next.empty()) break;
      ++rounds;
      for (const Pair& pair : next) {
        EXPECT_TRUE(chosen.insert(pair).second);
        EXPECT_LT(pair.first, pair.second);
      }
    }
    EXPECT_LT(rounds, 50);
    // Who may miss less, looks at more.
    EXPECT_GE(chosen.size(), last);
    EXPECT_LE(chosen.size(), 60U * 59U / 2U);
    last = chosen.size();
  }
  EXPECT_GT(last, 100U);
}

TEST(PairRounds, PairsOfOneGroupWait) {
  const std::vector<std::optional<KnownPose>> poses(60);
  Choice choice(poses, 0.3);
  // Twenty maps make one group: none of their pairs is looked at before the others are done.
  ConsistentSet grouped;
  NodeGroup group;
  for (std::size_t i = 0; i < 20; ++i) group.push_back({i, {}});
  grouped.groups.push_back(group);
  for (std::size_t i = 20; i < 60; ++i) grouped.groups.push_back({{i, {}}});
  const std::vector<Pair> pairs = choice.choice.next(0, choice.store, {}, grouped);
  ASSERT_FALSE(pairs.empty());
  for (const Pair& pair : pairs) EXPECT_FALSE(pair.first < 20 && pair.second < 20);
}

TEST(PairRounds, MapsThatAnAnswerLaysOnEachOtherAreLookedAtInTheEnd) {
  // All in one group: nothing is open, so that only what lies on each other is left.
  const std::vector<std::optional<KnownPose>> poses(60);
  Choice choice(poses, 0.3);
  ConsistentSet grouped;
  NodeGroup group;
  for (std::size_t i = 0; i < 60; ++i) group.push_back({i, SE2{0.5 * static_cast<double>(i), 0.0, 0.0}});
  grouped.groups.push_back(group);
  const std::vector<Pair> pairs = choice.choice.next(0, choice.store, {}, grouped);
  std::set<Pair> different(pairs.begin(), pairs.end());
  EXPECT_EQ(different.size(), pairs.size());
  ASSERT_FALSE(pairs.empty());
  for (const Pair& pair : pairs) EXPECT_LT(pair.second - pair.first, 4U);  // maps of 2 m
  for (std::size_t i = 0; i + 1 < 60; ++i) EXPECT_TRUE(different.contains({i, i + 1})) << i;
  // Not those that were looked at.
  std::set<Pair> chosen(different);
  chosen.erase({7, 8});
  EXPECT_EQ(choice.choice.next(0, choice.store, chosen, grouped), (std::vector<Pair>{{7, 8}}));
  // Where all lie on all, each has 16 others at least, and not all.
  for (PlacedNode& node : grouped.groups[0]) node.T_group_map = {};
  const std::vector<Pair> heap = choice.choice.next(0, choice.store, {}, grouped);
  std::vector<int> count(60, 0);
  for (const Pair& pair : heap) {
    ++count[pair.first];
    ++count[pair.second];
  }
  EXPECT_GE(*std::min_element(count.begin(), count.end()), 16);
  EXPECT_LT(heap.size(), 60U * 59U / 2U);
}

TEST(MergeResult, HasItsLargestComponentFirst) {
  const OccupancyGrid one = test::map_part(test::draw_building(1), {0, 0, 6, 6}, {});
  const OccupancyGrid other = test::map_part(test::draw_building(2), {0, 0, 6, 6}, {});
  // Copies are joined without a match. Whichever of two floors is there more often comes first, and of two
  // that are there as often the one with the first map.
  using Floors = std::vector<const OccupancyGrid*>;
  for (const auto& [a, b] : {std::pair(&one, &other), std::pair(&other, &one)}) {
    const auto merged = [](const Floors& floors) {
      std::vector<OccupancyGrid> maps;
      for (const OccupancyGrid* floor : floors) maps.push_back(*floor);
      return merge(maps);
    };
    const MergeResult more = merged({a, b, a, b, b});
    ASSERT_EQ(more.components.size(), 2U);
    EXPECT_EQ(more.components[0].members.size(), 3U);
    EXPECT_EQ(more.components[0].members.front().map, 1U);
    EXPECT_EQ(more.components[1].members.size(), 2U);
    const MergeResult even = merged({a, b, b, a});
    ASSERT_EQ(even.components.size(), 2U);
    EXPECT_EQ(even.components[0].members.front().map, 0U);
    EXPECT_EQ(even.components[1].members.front().map, 1U);
  }
}

}  // namespace
}  // namespace gridmerge::internal
