// SPDX-License-Identifier: Apache-2.0
// Which pairs of many maps are looked at.
#include "merge/pair_choice.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>
#include <limits>
#include <map>
#include <memory>
#include <numeric>
#include <optional>
#include <random>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "gridmerge/grid/resample.hpp"
#include "gridmerge/merge/merge.hpp"
#include "gridmerge/merge/merger.hpp"
#include "merge/map_store.hpp"
#include "merge/pair_looks.hpp"
#include "merge/team.hpp"
#include "preselect/chance.hpp"
#include "preselect/signature.hpp"

namespace gridmerge {
namespace {

using test::draw_building;
using test::expect_same;
using test::map_part;

/// Two maps of each of several floors, all from frames of their own.
struct Fleet {
  explicit Fleet(std::size_t count) {
    for (unsigned seed = 1; maps.size() < count; ++seed) {
      const OccupancyGrid building = draw_building(seed);
      for (const test::Window& window : {test::Window{0, 0, 12, 13}, test::Window{4, 0, 18, 13}}) {
        const double i = static_cast<double>(maps.size());
        T_map_floor.push_back({2.0 * i, -i, 0.37 * i});
        maps.push_back(downsample(map_part(building, window, T_map_floor.back()), 2));
      }
    }
  }

  /// What a match would find that is always right, and nearly always sure.
  MatchResult match(std::size_t fixed, std::size_t moving) const {
    MatchResult result;
    if (fixed / 2 != moving / 2) return result;
    result.T_fixed_moving = T_map_floor[fixed] * inverse(T_map_floor[moving]);
    result.probability = 0.999;
    result.verdict = Verdict::accepted;
    result.reason = Reason::none;
    result.hypotheses = {{result.T_fixed_moving, 1.0, 0.999}};
    result.hypotheses[0].figures.sigma = 0.1;
    return result;
  }

  std::vector<OccupancyGrid> maps;
  std::vector<SE2> T_map_floor;
};

MergeOptions options(double max_missed, int threads = 2) {
  MergeOptions options;
  options.max_missed = max_missed;
  options.match.threads = threads;
  options.match.search = SearchMethod::quick;  // one look is enough to choose by
  return options;
}

/// A merge of the first `count` maps of `order`, with matches that are made elsewhere.
MergeResult merge_of(const Fleet& fleet, const std::vector<std::size_t>& order, const MergeOptions& options,
                     std::size_t* matches = nullptr) {
  Merger merger(options);
  for (const std::size_t map : order) merger.add(fleet.maps[map]);
  std::size_t made = 0;
  for (std::vector<DueMatch> due = merger.due(); !due.empty(); due = merger.due()) {
    for (const DueMatch& one : due) merger.hand_in(one, fleet.match(order[one.fixed], order[one.moving]));
    made += due.size();
  }
  if (matches != nullptr) *matches = made;
  return merger.solve();
}

/// The maps of each component.
std::set<std::set<std::size_t>> parts_of(const MergeResult& result, const std::vector<std::size_t>& order) {
  std::set<std::set<std::size_t>> parts;
  for (const Component& component : result.components) {
    std::set<std::size_t> part;
    for (const Member& member : component.members) part.insert(order[member.map]);
    parts.insert(part);
  }
  return parts;
}

std::vector<std::size_t> in_order(std::size_t count) {
  std::vector<std::size_t> order(count);
  std::iota(order.begin(), order.end(), 0);
  return order;
}

TEST(PairChoice, OfFewMapsAllPairsAreLookedAt) {
  const internal::PairChoice some(0.25), hidden(0.2), none(0.0);
  EXPECT_TRUE(some.takes_all(internal::kFewMaps));
  EXPECT_FALSE(some.takes_all(internal::kFewMaps + 1));
  EXPECT_TRUE(none.takes_all(100000));
  EXPECT_TRUE(hidden.takes_all(100000));
  EXPECT_TRUE(internal::takes_all_pairs(100000, 0.2));
  EXPECT_FALSE(internal::takes_all_pairs(internal::kFewMaps + 1, 0.21));
}

TEST(PairChoice, AShareThatMakesNoSenseIsRefused) {
  EXPECT_THROW(merge({}, options(-0.1)), std::invalid_argument);
  EXPECT_THROW(merge({}, options(1.0)), std::invalid_argument);
  EXPECT_THROW(merge({}, options(std::numeric_limits<double>::quiet_NaN())), std::invalid_argument);
}

TEST(PairChoice, FewerPairsMakeTheSameMapsWhateverTheOrderAndTheThreads) {
  const Fleet fleet(60);
  const std::vector<std::size_t> order = in_order(60);
  std::size_t of_all = 0, of_some = 0;
  MergeOptions all = options(0.0), some = options(0.5), one_thread = options(0.5, 1);
  for (MergeOptions* each : {&all, &some, &one_thread}) each->max_false_joins = 1.0;
  const MergeResult expected = merge_of(fleet, order, all, &of_all);
  const MergeResult result = merge_of(fleet, order, some, &of_some);
  EXPECT_EQ(of_all, 60u * 59u / 2u);
  EXPECT_LT(of_some, of_all);
  EXPECT_EQ(result.joins.size(), of_some);
  EXPECT_FALSE(expected.not_compared);
  ASSERT_TRUE(result.not_compared);
  EXPECT_EQ(result.not_compared->pairs, of_all - of_some);
  // At most the half of all joins that may be missed; the fifth that signatures do not show is among them.
  const double joins = static_cast<double>(
      std::count_if(result.joins.begin(), result.joins.end(), [](const Join& join) { return join.used(); }));
  EXPECT_GE(result.not_compared->expected_joins, 0.2 * joins);
  EXPECT_LE(result.not_compared->expected_joins, joins);
  EXPECT_EQ(parts_of(expected, order).size(), 30u);
  EXPECT_EQ(parts_of(result, order), parts_of(expected, order));
  expect_same(merge_of(fleet, order, one_thread), result);

  std::vector<std::size_t> shuffled = order;
  std::shuffle(shuffled.begin(), shuffled.end(), std::mt19937(5));
  const MergeResult other = merge_of(fleet, shuffled, some);
  EXPECT_EQ(parts_of(other, shuffled), parts_of(result, order));
  std::set<std::pair<std::size_t, std::size_t>> pairs, other_pairs;
  for (const Join& join : result.joins) pairs.insert({join.fixed, join.moving});
  for (const Join& join : other.joins)
    other_pairs.insert(std::minmax(shuffled[join.fixed], shuffled[join.moving]));
  EXPECT_EQ(other_pairs, pairs);
  ASSERT_TRUE(other.not_compared);
  EXPECT_EQ(other.not_compared->pairs, result.not_compared->pairs);
  EXPECT_EQ(other.not_compared->expected_joins, result.not_compared->expected_joins);
}

/// A store of the fleet's maps, each in a frame of its own: every `step`th one from `first` on.
internal::MapStore store_of(const Fleet& fleet, std::size_t first = 0, std::size_t step = 1) {
  internal::MapStore store;
  for (std::size_t i = first; i < fleet.maps.size(); i += step)
    store.add(std::make_unique<const internal::MapStore::Input>(
                  std::make_shared<const OccupancyGrid>(fleet.maps[i])),
              std::nullopt);
  return store;
}

/// A group's signature tells with which maps it may share a place: others are not worth a match.
TEST(PairChoice, OfMeetingsThoseAreWorthAMatchThatMayMakeNearlyAllJoins) {
  const Fleet fleet(24);
  const internal::MapStore store = store_of(fleet, 1, 2);
  const std::vector<internal::MapStore::MapId> maps = store.ids();
  internal::PairChoice choice(0.9);
  choice.prepare(store, maps);
  std::vector<std::unique_ptr<PreparedMap>> groups;
  groups.push_back(std::make_unique<PreparedMap>(fleet.maps[4]));
  std::vector<std::pair<std::size_t, std::size_t>> meetings;
  for (std::size_t i = 0; i < maps.size(); ++i) meetings.emplace_back(0, i);
  const std::vector<bool> worth = choice.worth_meeting(groups, meetings, 0);
  EXPECT_TRUE(worth.at(2)) << "the other map of the same floor";
  EXPECT_LE(2 * std::count(worth.begin(), worth.end(), true), std::ssize(worth)) << "of others a few";
}

/// Where the first looks say the same of all pairs, signatures say which of them get a second one.
TEST(PairChoice, PairsThatSignaturesExpectToJoinGetASecondLook) {
  const Fleet fleet(20);
  const internal::MapStore store = store_of(fleet);
  const std::vector<internal::MapStore::MapId> maps = store.in_canonical_order();
  internal::PairChoice choice(0.9);
  choice.prepare(store, maps);
  internal::PairLooks looks{MatchOptions{}};
  std::vector<internal::Signature> signatures;
  for (const internal::MapStore::MapId id : maps)
    signatures.push_back(internal::make_signature(store.at(id).prepared.known()));
  std::vector<internal::PairChoice::Pair> apart;
  std::map<internal::PairChoice::Pair, double> log_odds;
  for (std::size_t a = 0; a < maps.size(); ++a) {
    for (std::size_t b = a + 1; b < maps.size(); ++b) {
      const internal::Signature &moving = signatures[a], &fixed = signatures[b];
      apart.emplace_back(maps[a], maps[b]);
      log_odds[apart.back()] = internal::log_odds_of_joining(internal::compare(fixed, moving), fixed, moving);
      looks.hand_in(apart.back(), looks.first_search(), MatchResult{});
    }
  }
  const auto worth = choice.worth_a_second_look(apart, looks, {});
  ASSERT_FALSE(worth.empty());
  ASSERT_LT(worth.size(), apart.size());
  double least = std::numeric_limits<double>::infinity();
  for (const auto& pair : worth) {
    least = std::min(least, log_odds.at(pair));
    log_odds.erase(pair);
  }
  for (const auto& [pair, other] : log_odds)
    EXPECT_LE(other, least + 1e-4) << pair.first << ' ' << pair.second;
}

/// What a merge of the maps, with comparisons of this store, would match first.
std::vector<DueMatch> first_due(const Fleet& fleet, const ComparisonStore& store) {
  Merger merger(fleet.maps, options(0.5));
  merger.keep_comparisons(store);
  return merger.due();
}

void expect_same_due(const std::vector<DueMatch>& a, const std::vector<DueMatch>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].fixed, b[i].fixed);
    EXPECT_EQ(a[i].moving, b[i].moving);
  }
}

TEST(PairChoice, ComparisonsThatAreKeptAreNotMadeAgain) {
  const Fleet fleet(internal::kFewMaps + 2);
  std::map<std::string, std::vector<float>> kept;
  std::vector<std::string> made;
  ComparisonStore store;
  store.find = [&](const std::string& name) {
    const auto part = kept.find(name);
    return part == kept.end() ? std::nullopt : std::optional(part->second);
  };
  store.keep = [&](const std::string& name, const std::vector<float>& log_odds) {
    kept[name] = log_odds;
    made.push_back(name);
  };
  const std::vector<DueMatch> plain = first_due(fleet, {});
  ASSERT_GT(plain.size(), 5u);
  expect_same_due(first_due(fleet, store), plain);
  const std::vector<std::string> in_turn = made;
  EXPECT_GT(in_turn.size(), 8u);
  std::size_t pairs = 0;
  for (const auto& [name, log_odds] : kept) pairs += log_odds.size();
  EXPECT_EQ(pairs, fleet.maps.size() * (fleet.maps.size() - 1) / 2);

  made.clear();
  expect_same_due(first_due(fleet, store), plain);
  EXPECT_TRUE(made.empty());

  kept.erase(in_turn[3]);
  kept[in_turn[5]].pop_back();  // none of this size is due
  store.begin = 0.9;            // another process begins elsewhere, and finds the others all the same
  expect_same_due(first_due(fleet, store), plain);
  EXPECT_EQ(made, (std::vector<std::string>{in_turn[3], in_turn[5]}));
  kept.clear();
  made.clear();
  expect_same_due(first_due(fleet, store), plain);
  EXPECT_NE(made.front(), in_turn.front());
  EXPECT_TRUE(std::is_permutation(made.begin(), made.end(), in_turn.begin(), in_turn.end()));

  for (auto& [name, log_odds] : kept)
    for (float& one : log_odds) one = -one;
  EXPECT_NE(first_due(fleet, store).size(), plain.size()) << "they are used";
  made.clear();
  const Fleet others(internal::kFewMaps + 4);
  first_due(others, store);
  EXPECT_FALSE(made.empty()) << "of other maps";
}

TEST(PairChoice, ManyMapsHaveABudgetOfFalseJoinsForEveryFifty) {
  const Fleet fleet(100);
  const auto joined = [&](std::size_t maps, double budget) {
    MergeOptions some = options(0.5);
    some.max_false_joins = budget;
    const MergeResult result = merge_of(fleet, in_order(maps), some);
    EXPECT_LE(result.expected_false_joins, budget * std::max(1.0, static_cast<double>(maps) / 50.0));
    return result.components.size();
  };
  // Each of these joins of two is false in more than one of 100 cases, by what is believed of them.
  const std::size_t of_few = joined(internal::kFewMaps, 0.5);
  EXPECT_EQ(of_few, 25u);
  EXPECT_EQ(joined(100, 0.5), 2 * of_few);
  EXPECT_EQ(joined(100, 0.0), 0u);
}

TEST(PairChoice, HostileMapsAmongManyAreLeftOut) {
  Fleet fleet(48);
  const std::size_t good = fleet.maps.size();
  fleet.maps.push_back(make_grid(50, 50, 0.05));
  fleet.maps.push_back(make_grid(50, 50, 0.05, {}, Cell::free));
  fleet.maps.push_back(make_grid(50, 50, 0.05, {}, Cell::occupied));
  fleet.maps.push_back(make_grid(1, 1, 0.05));
  fleet.maps.push_back(fleet.maps[0]);  // a copy
  Merger merger(fleet.maps, options(0.9));
  for (std::vector<DueMatch> due = merger.due(); !due.empty(); due = merger.due()) {
    for (const DueMatch& one : due) {
      const bool both_good = std::max(one.fixed, one.moving) < good;
      merger.hand_in(one, both_good ? fleet.match(one.fixed, one.moving) : merger.make(one));
    }
  }
  const MergeResult result = merger.solve();
  for (std::size_t map = good; map < good + 4; ++map) {
    EXPECT_TRUE(std::any_of(result.left_out.begin(), result.left_out.end(), [&](const LeftOut& one) {
      return one.map == map;
    })) << map;
  }
  const auto of_copy =
      std::find_if(result.components.begin(), result.components.end(), [&](const Component& one) {
        return std::any_of(one.members.begin(), one.members.end(),
                           [&](const Member& member) { return member.map == good + 4; });
      });
  ASSERT_NE(of_copy, result.components.end());
  EXPECT_EQ(of_copy->members.front().map, 0u);
}

}  // namespace
}  // namespace gridmerge
