// SPDX-License-Identifier: Apache-2.0
// Which pairs of many maps are looked at.
#include "merge/pair_choice.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <numeric>
#include <random>
#include <set>
#include <stdexcept>
#include <vector>

#include "gridmerge/grid/resample.hpp"
#include "gridmerge/merge/merge.hpp"
#include "gridmerge/merge/merger.hpp"
#include "merge/team.hpp"

namespace gridmerge {
namespace {

using test::draw_building;
using test::expect_same;
using test::map_part;

/// Two or three maps of each of several floors, all from frames of their own.
struct Fleet {
  explicit Fleet(std::size_t count) {
    for (unsigned seed = 1; maps.size() < count; ++seed) {
      const OccupancyGrid building = draw_building(seed);
      for (const test::Window& window : {test::Window{0, 0, 12, 13}, test::Window{4, 0, 18, 13}}) {
        const double i = static_cast<double>(maps.size());
        if (maps.size() < count)
          maps.push_back(downsample(map_part(building, window, {2.0 * i, -i, 0.37 * i}), 2));
      }
    }
  }
  std::vector<OccupancyGrid> maps;
};

MergeOptions options(double max_missed, int threads = 2) {
  MergeOptions options;
  options.max_missed = max_missed;
  options.match.threads = threads;
  options.match.search = SearchMethod::quick;  // one look is enough to choose by
  return options;
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
  const internal::PairChoice some(0.05), none(0.0);
  EXPECT_TRUE(some.takes_all(internal::kFewMaps));
  EXPECT_FALSE(some.takes_all(internal::kFewMaps + 1));
  EXPECT_TRUE(none.takes_all(100000));
}

TEST(PairChoice, AShareThatMakesNoSenseIsRefused) {
  EXPECT_THROW(merge({}, options(-0.1)), std::invalid_argument);
  EXPECT_THROW(merge({}, options(1.0)), std::invalid_argument);
  EXPECT_THROW(merge({}, options(std::numeric_limits<double>::quiet_NaN())), std::invalid_argument);
}

TEST(PairChoice, FewerPairsMakeTheSameMapsWhateverTheOrderAndTheThreads) {
  const Fleet fleet(52);
  const std::vector<std::size_t> order = in_order(fleet.maps.size());
  const MergeResult all = merge(fleet.maps, options(0.0));
  const MergeResult some = merge(fleet.maps, options(0.3));
  EXPECT_EQ(all.joins.size(), 1326u);
  EXPECT_LE(some.joins.size(), all.joins.size());  // these floors all look alike
  EXPECT_EQ(parts_of(some, order), parts_of(all, order));
  expect_same(merge(fleet.maps, options(0.3, 1)), some);

  std::vector<std::size_t> shuffled = order;
  std::shuffle(shuffled.begin(), shuffled.end(), std::mt19937(5));
  std::vector<OccupancyGrid> maps;
  for (const std::size_t i : shuffled) maps.push_back(fleet.maps[i]);
  const MergeResult other = merge(maps, options(0.3));
  EXPECT_EQ(parts_of(other, shuffled), parts_of(some, order));
  std::set<std::pair<std::size_t, std::size_t>> pairs, other_pairs;
  for (const Join& join : some.joins) pairs.insert({join.fixed, join.moving});
  for (const Join& join : other.joins)
    other_pairs.insert(std::minmax(shuffled[join.fixed], shuffled[join.moving]));
  EXPECT_EQ(other_pairs, pairs);

  // And when the matches are made elsewhere.
  Merger merger(options(0.3));
  for (const OccupancyGrid& map : fleet.maps) merger.add(map);
  for (std::vector<DueMatch> due = merger.due(); !due.empty(); due = merger.due()) {
    for (const DueMatch& one : due)
      merger.hand_in(one,
                     match(fleet.maps[one.fixed], fleet.maps[one.moving], merger.match_options(one.search)));
  }
  expect_same(merger.solve(), some);
}

TEST(PairChoice, HostileMapsAmongManyAreLeftOut) {
  Fleet fleet(48);
  const std::size_t good = fleet.maps.size();
  fleet.maps.push_back(make_grid(50, 50, 0.05));
  fleet.maps.push_back(make_grid(50, 50, 0.05, {}, Cell::free));
  fleet.maps.push_back(make_grid(50, 50, 0.05, {}, Cell::occupied));
  fleet.maps.push_back(make_grid(1, 1, 0.05));
  fleet.maps.push_back(fleet.maps[0]);  // a copy
  const MergeResult result = merge(fleet.maps, options(0.5));
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
