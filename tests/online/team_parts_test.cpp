// SPDX-License-Identifier: Apache-2.0
// Parts of maps that a team hears, what they cost, and when they count as heard.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <future>
#include <memory>
#include <vector>

#include "gridmerge/online/team.hpp"
#include "patience.hpp"
#include "scarce_memory.hpp"
#include "set_clock.hpp"

namespace gridmerge {
namespace {

using namespace std::chrono_literals;
using test::impatient;
using test::kLong;

OccupancyGrid floor_of(int side, Cell cell = Cell::free) {
  return make_grid(side, side, 0.05, {}, cell);
}

TEST(PartsOfMaps, AreDrawnIntoAMapThatStillWaits) {
  if (!test::kMemoryCanBeScarce) GTEST_SKIP() << "memory is never scarce under ThreadSanitizer";
  constexpr int kSide = 1000;
  std::promise<void> is_busy, goes_on;
  std::atomic<bool> is_held = false;
  Team team(impatient(), [&](const std::shared_ptr<const TeamAnswer>&) {
    if (is_held.exchange(true)) return;
    is_busy.set_value();
    goes_on.get_future().wait();  // until then whatever is heard waits
  });
  team.hear("anna", floor_of(3));
  is_busy.get_future().wait();
  team.hear("anna", floor_of(kSide));
  const OccupancyGrid part = floor_of(10, Cell::occupied);
  test::scarce_from = std::size_t{kSide} * kSide;  // there is room for no other such map
  bool is_drawn = false;
  EXPECT_NO_THROW(is_drawn = team.hear_part("anna", 5, 6, part));
  test::scarce_from = 0;
  EXPECT_TRUE(is_drawn);
  goes_on.set_value();
  ASSERT_TRUE(team.wait_until_settled(kLong));
  const OccupancyGrid& map = *team.answer()->merge->maps.at(0);
  EXPECT_EQ(map.at(5, 6), Cell::occupied);
  EXPECT_EQ(std::count(map.cells.begin(), map.cells.end(), Cell::occupied), 100);
}

TEST(PartsOfMaps, ChangeNoMapThatATeamIsAtWorkOnOrHasTold) {
  const OccupancyGrid part = floor_of(1, Cell::occupied);
  Team team(impatient());
  team.hear("anna", floor_of(3));
  ASSERT_TRUE(team.wait_until_settled(kLong));
  const auto told = team.answer()->merge->maps.at(0);
  for (int column = 0; column < 3; ++column) EXPECT_TRUE(team.hear_part("anna", column, 0, part));
  ASSERT_TRUE(team.wait_until_settled(kLong));
  EXPECT_EQ(told->cells, floor_of(3).cells);
  const auto newer = team.answer()->merge->maps.at(0);
  EXPECT_EQ(std::count(newer->cells.begin(), newer->cells.end(), Cell::occupied), 3);
}

TEST(PartsOfMaps, BringTheirProbabilitiesAndWithoutThemThereAreNone) {
  const auto with_probability = [](OccupancyGrid map, float probability) {
    map.probability.assign(map.cells.size(), probability);
    return map;
  };
  Team team(impatient());
  const auto probability_after = [&](const OccupancyGrid& part) {
    EXPECT_TRUE(team.hear_part("anna", 1, 0, part));
    EXPECT_TRUE(team.wait_until_settled(kLong));
    return team.answer()->merge->maps.at(0)->probability;
  };
  team.hear("anna", with_probability(floor_of(2), 0.25F));
  EXPECT_EQ(probability_after(with_probability(floor_of(1, Cell::occupied), 0.75F)),
            (std::vector<float>{0.25F, 0.75F, 0.25F, 0.25F}));
  EXPECT_TRUE(probability_after(floor_of(1)).empty());
  EXPECT_TRUE(probability_after(with_probability(floor_of(1, Cell::occupied), 0.75F)).empty());
}

TEST(PartsOfMaps, MakeNoRobotOlderWhoseClockIsSetBack) {
  const auto now = std::chrono::system_clock::now();
  Team team(impatient());
  const auto heard_first = [&] {
    EXPECT_TRUE(team.wait_until_settled(kLong));
    return team.answer()->robots.at(0).heard_first;
  };
  team.hear("anna", floor_of(3));
  const TeamTime first = heard_first();
  EXPECT_GE(first, now);
  const test::SetClock set_back(-3600);
  const bool is_set_back = std::chrono::system_clock::now() < now;
  EXPECT_TRUE(team.hear_part("anna", 0, 0, floor_of(1, Cell::occupied)));
  EXPECT_EQ(heard_first(), first);
  team.hear("anna", floor_of(4));  // nor does a whole map
  EXPECT_EQ(heard_first(), first);
  team.hear_age("anna", now - 1s);  // another one's word does
  EXPECT_EQ(heard_first(), now - 1s);
  EXPECT_TRUE(is_set_back);
}

/// It is quiet when nothing was heard for so long, not when the team is so old.
TEST(PartsOfMaps, BeginTheQuietAnew) {
  TeamOptions options;
  options.quiet = 100ms;
  options.search_again = 1.0;
  Team team(options);
  team.hear("anna", floor_of(10));
  ASSERT_TRUE(team.wait_until_settled(kLong));
  for (int column = 0; column < 3; ++column) {
    const auto begin = std::chrono::steady_clock::now();
    EXPECT_TRUE(team.hear_part("anna", column, 0, floor_of(1, Cell::occupied)));
    ASSERT_TRUE(team.wait_until_settled(kLong));
    EXPECT_GE(std::chrono::steady_clock::now() - begin, options.quiet);
  }
}

}  // namespace
}  // namespace gridmerge
