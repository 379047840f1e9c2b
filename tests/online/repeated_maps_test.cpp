// SPDX-License-Identifier: Apache-2.0
// Robots that publish what they published before.
#include <gtest/gtest.h>

#include <atomic>
#include <thread>

#include "gridmerge/grid/resample.hpp"
#include "gridmerge/merge/merge.hpp"
#include "patience.hpp"
#include "solver_news.hpp"

namespace gridmerge {
namespace {

using namespace std::chrono_literals;
using test::Explorers;
using test::kLong;

TEST(RepeatedMaps, MakeNoAnswers) {
  const Explorers explorers;
  TeamOptions options;
  options.quiet = 10ms;
  std::atomic<int> answers = 0;
  Team team(options, [&](const std::shared_ptr<const TeamAnswer>&) { ++answers; });
  team.hear("anna", explorers.map(0, 5));
  team.hear("bert", explorers.map(1, 5));
  ASSERT_TRUE(team.wait_until_settled(kLong));
  ASSERT_FALSE(team.take_events().empty());
  const auto before = team.answer();
  const int answers_before = answers;
  OccupancyGrid part = make_grid(9, 7, 0.05);
  for (int row = 0; row < part.height; ++row) {
    for (int column = 0; column < part.width; ++column)
      part.at(column, row) = explorers.map(0, 5).at(column + 20, row + 30);
  }
  for (int i = 0; i < 10; ++i) {
    team.hear("bert", explorers.map(1, 5));
    EXPECT_TRUE(team.hear_part("anna", 20, 30, part));
    std::this_thread::sleep_for(2ms);
  }
  ASSERT_TRUE(team.wait_until_settled(kLong));
  const auto answer = team.answer();
  EXPECT_EQ(answer->number, before->number);
  EXPECT_EQ(answers, answers_before);
  EXPECT_TRUE(team.take_events().empty());
  for (std::size_t i = 0; i < 2; ++i) EXPECT_EQ(answer->robots.at(i).maps_heard, 11u) << "they are counted";
  part.at(3, 3) = part.at(3, 3) == Cell::free ? Cell::occupied : Cell::free;
  EXPECT_TRUE(team.hear_part("anna", 20, 30, part));
  ASSERT_TRUE(team.wait_until_settled(kLong));
  EXPECT_GT(team.answer()->number, before->number);
}

/// A robot that stands publishes its map on and on.
TEST(RepeatedMaps, DoNotPutOffTheSearchOfAll) {
  const Explorers explorers;
  TeamOptions options;
  options.quiet = 100ms;
  Team team(options);
  OccupancyGrid map = explorers.map(1, 5);
  team.hear("anna", explorers.map(0, 5));
  team.hear("bert", map);
  ASSERT_TRUE(team.wait_until_settled(kLong));
  for (int column = 0; column < 3; ++column) map.at(column, 0) = Cell::occupied;  // too little to be searched
  const auto end = std::chrono::steady_clock::now() + kLong;
  do {
    ASSERT_LT(std::chrono::steady_clock::now(), end);
    team.hear("bert", map);
    team.hear("anna", explorers.map(0, 5));
  } while (!team.wait_until_settled(1ms));
  const auto answer = team.answer();
  EXPECT_TRUE(answer->settled);
  EXPECT_EQ(answer->merge->maps.at(1)->cells, map.cells);
  const MergeResult merged = merge({explorers.map(0, 5), map});
  ASSERT_EQ(answer->components.size(), 1u);
  EXPECT_EQ(answer->components[0].map->cells, merged.components.at(0).fused.grid.cells)
      << "what was drawn too";
}

TEST(RepeatedMaps, HaveTheNumberOfTheAnswerBefore) {
  using internal::TeamSolver;
  const Explorers explorers;
  TeamSolver solver({});
  solver.take(test::news_at(explorers, 5));
  const TeamAnswer before = solver.solve(TeamSolver::Effort::full);
  solver.take(test::news_at(explorers, 5));
  TeamAnswer answer = solver.solve(TeamSolver::Effort::soon);
  EXPECT_EQ(answer.number, before.number);
  EXPECT_EQ(answer.robots.at(0).maps_heard, 2u);
  EXPECT_EQ(answer.merge, before.merge);
  test::News news;
  news["carl"].is_gone = true;
  solver.take(std::move(news));
  answer = solver.solve(TeamSolver::Effort::soon);
  EXPECT_EQ(answer.number, before.number + 1);
}

}  // namespace
}  // namespace gridmerge
