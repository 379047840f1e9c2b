// SPDX-License-Identifier: Apache-2.0
// What a team does at limits that small maps meet to the cell.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <numbers>
#include <optional>
#include <string>

#include "online/solver.hpp"
#include "solver_news.hpp"
#include "support/effort.hpp"

namespace gridmerge::internal {
namespace {

using Effort = TeamSolver::Effort;
using test::map_news;
using test::status_of;

OccupancyGrid floor_of(int side) {
  return make_grid(side, side, 0.1, {}, Cell::free);
}

/// Two robots whose poses are given lie together, whatever is on their maps.
News two_fixed(const OccupancyGrid& anna, const OccupancyGrid& bert, const SE2& T_anna_bert) {
  News news;
  news["anna"] = map_news(anna);
  news["anna"].known_pose = KnownPose{{}, 0.0, 0.0, true};
  news["bert"] = map_news(bert, 1);
  news["bert"].known_pose = KnownPose{T_anna_bert, 0.0, 0.0, true};
  return news;
}

/// Whether the map was searched anew once the looks that are due at once are made.
bool is_searched(TeamSolver& solver, const OccupancyGrid& map) {
  solver.take({{"bert", map_news(map, 1)}});
  solver.solve(Effort::soon);
  solver.solve(Effort::further);
  return solver.is_settled();
}

TEST(TeamOfSmallMaps, SearchesAPlacedMapFromThatVeryShareOn) {
  TeamOptions options;
  options.search_again = 1.0 / 64.0;
  TeamSolver solver(options);
  OccupancyGrid map = floor_of(8);
  solver.take(two_fixed(floor_of(9), map, {2.0, 0.0, 0.0}));
  ASSERT_EQ(status_of(solver.solve(Effort::full), "bert").state, RobotState::placed);
  map.at(3, 4) = Cell::unknown;  // one of 64
  EXPECT_TRUE(is_searched(solver, map));
}

/// It is waited for: a quarter of the share is enough.
TEST(TeamOfSmallMaps, SearchesTheMapOfARobotThatLiesNowhereSooner) {
  TeamOptions options;
  options.search_again = 0.4;
  TeamSolver solver(options);
  OccupancyGrid map = floor_of(10);
  solver.take({{"bert", map_news(map, 1)}});
  ASSERT_EQ(status_of(solver.solve(Effort::full), "bert").state, RobotState::waiting);
  const auto is_searched_without = [&](std::ptrdiff_t cells) {
    std::fill_n(map.cells.begin(), cells, Cell::unknown);
    return is_searched(solver, map);
  };
  EXPECT_FALSE(is_searched_without(9)) << "of 100";
  EXPECT_TRUE(is_searched_without(11));
}

/// A user who says where a robot is need not say it as often as maps do that say so.
TEST(TeamOfSmallMaps, TakesAPoseThatIsSaidAtOnce) {
  TeamSolver solver({});
  solver.take(two_fixed(floor_of(9), floor_of(8), {2.0, 0.0, 0.0}));
  ASSERT_EQ(status_of(solver.solve(Effort::full), "bert").T_world_map, (SE2{2.0, 0.0, 0.0}));
  News news;
  news["bert"].known_pose = KnownPose{{30.0, 0.0, 0.0}, 0.0, 0.0, true};
  solver.take(news);
  EXPECT_EQ(status_of(solver.solve(Effort::soon), "bert").T_world_map, (SE2{30.0, 0.0, 0.0}));
  // Taken back, it says nothing any more: a floor without walls lies nowhere by itself.
  news["bert"].known_pose = std::optional<KnownPose>();
  solver.take(news);
  EXPECT_NE(status_of(solver.solve(Effort::soon), "bert").state, RobotState::placed);
}

/// So many robots in buildings of their own, the names of which count from 1.
News strangers(unsigned robots, double side) {
  News news;
  for (unsigned building = 1; building <= robots; ++building)
    news[std::to_string(building)] = map_news(
        test::map_part(test::draw_building(building), {0, 0, side, side}, {}), static_cast<int>(building));
  return news;
}

TEST(TeamOfSmallMaps, LooksAtFourPairsAgainUntilTheNextAnswer) {
  const unsigned robots = test::repeats(5U, 4U);
  TeamSolver solver({});
  solver.take(strangers(robots, 3.0));  // each of the ten (or six) pairs is looked at again
  solver.solve(Effort::soon);
  int answers = 0;
  for (; !solver.is_complete(); ++answers) solver.solve(Effort::further);
  EXPECT_EQ(answers, robots == 5U ? 3 : 2) << "with four, four and two of them (or four and two)";
}

/// A team works on without an end: nobody is told how far single merges and matches are.
TEST(TeamOfSmallMaps, TellsNoProgress) {
  int told = 0;
  TeamOptions options;
  options.merge.progress = [&](std::size_t, std::size_t) { ++told; };
  options.merge.match.progress = [&](double) { ++told; };
  TeamSolver solver(options);
  solver.take(strangers(2, 5.0));
  ASSERT_EQ(solver.solve(Effort::full).robots.size(), 2u);
  EXPECT_EQ(told, 0);
}

TEST(TeamOfSmallMaps, SaysHowFarTheCellsOfAMapHaveJumped) {
  OccupancyGrid map = floor_of(1);
  map.origin = {9.95, -0.05, 0.0};  // all of it lies around (10, 0)
  TeamSolver solver({});
  solver.take(two_fixed(floor_of(5), map, {30.0, 0.0, 0.0}));
  ASSERT_EQ(status_of(solver.solve(Effort::full), "bert").state, RobotState::placed);
  // The origin of its frame, about which it is turned, stays.
  solver.take(two_fixed(floor_of(5), map, {30.0, 0.0, std::numbers::pi}));
  const TeamAnswer answer = solver.solve(Effort::full);
  const auto of_bert = std::find_if(answer.events.begin(), answer.events.end(),
                                    [](const TeamEvent& event) { return event.robot == "bert"; });
  ASSERT_NE(of_bert, answer.events.end());
  EXPECT_EQ(of_bert->text, "bert moved by 20.0 m: its newer place is confirmed");
}

}  // namespace
}  // namespace gridmerge::internal
