// SPDX-License-Identifier: Apache-2.0
// Groups of robots in two buildings, and whose frame they have.
#include <gtest/gtest.h>

#include <algorithm>

#include "solver_news.hpp"

namespace gridmerge::internal {
namespace {

using Effort = TeamSolver::Effort;
using test::expect_at;
using test::expect_consistent;
using test::Explorers;
using test::map_news;
using test::news_at;
using test::status_of;

/// The map of one of three robots in the building where dora is, from a frame of its own.
OccupancyGrid elsewhere(int robot) {
  const OccupancyGrid building = test::draw_building(2);
  const test::Window windows[] = {{0, 0, 12, 13}, {5, 0, 18, 13}, {0, 3, 18, 13}};
  return test::map_part(building, windows[robot], {2.0 * robot, 1.0, 0.4 * robot});
}

News news_elsewhere(int first, int robots) {
  const std::vector<std::string> names{"dora", "erna", "fred"};
  News news;
  for (int robot = 0; robot < robots; ++robot)
    news[names.at(static_cast<std::size_t>(robot))] = map_news(elsewhere(robot), first + robot);
  return news;
}

std::vector<std::size_t> numbers_of(const TeamAnswer& answer) {
  std::vector<std::size_t> numbers;
  for (const TeamComponent& component : answer.components) numbers.push_back(component.number);
  return numbers;
}

std::size_t number_of(const TeamAnswer& answer, const std::string& robot) {
  const RobotStatus& status = status_of(answer, robot);
  return status.component ? answer.components.at(*status.component).number : 0;
}

bool has_event(const TeamAnswer& answer, TeamEvent::Kind kind) {
  return std::any_of(answer.events.begin(), answer.events.end(),
                     [&](const TeamEvent& event) { return event.kind == kind; });
}

TEST(TeamSolverGroups, KeepTheirNumbersWhenALargerOneComes) {
  const Explorers explorers;
  TeamSolver solver({});
  solver.take(news_at(explorers, 5, 2));
  EXPECT_EQ(numbers_of(solver.solve(Effort::full)), std::vector<std::size_t>{1});
  solver.take(news_elsewhere(10, 3));
  TeamAnswer answer = solver.solve(Effort::full);
  EXPECT_EQ(number_of(answer, "anna"), 1u);
  EXPECT_EQ(number_of(answer, "fred"), 2u);
  expect_consistent(answer);
  // With the first two apart, the others keep their number.
  solver.take({{"bert", map_news(make_grid(50, 50, 0.05))}});
  answer = solver.solve(Effort::full);
  EXPECT_EQ(number_of(answer, "anna"), 0u);
  EXPECT_EQ(numbers_of(answer), std::vector<std::size_t>{2});
  expect_consistent(answer);
  solver.take({{"bert", map_news(explorers.map(1, 5))}});
  answer = solver.solve(Effort::full);
  EXPECT_EQ(number_of(answer, "bert"), 1u);
  EXPECT_FALSE(has_event(answer, TeamEvent::Kind::renumbered));
}

TEST(TeamSolverGroups, TheFrameOfFixedPosesIsNumberOne) {
  const Explorers explorers;
  TeamSolver solver({});
  News news = news_elsewhere(0, 3);
  news["anna"].known_pose = KnownPose{{100.0, 50.0, 1.0}, 0.0, 0.0, true};
  solver.take(std::move(news));
  EXPECT_EQ(numbers_of(solver.solve(Effort::full)), std::vector<std::size_t>{2});
  solver.take(news_at(explorers, 5, 2));
  TeamAnswer answer = solver.solve(Effort::full);
  EXPECT_EQ(number_of(answer, "anna"), 1u);
  EXPECT_EQ(number_of(answer, "dora"), 2u);
  EXPECT_TRUE(status_of(answer, "anna").has_known_pose);
  EXPECT_FALSE(status_of(answer, "bert").has_known_pose);
}

/// SLAM may begin anew in the same program, with the same frame's name.
TEST(TeamSolverGroups, AKnownPoseEndsWithItsFrame) {
  const Explorers explorers;
  TeamSolver solver({});
  News news = news_at(explorers, 5, 2);
  const SE2 T_world_anna{100.0, 50.0, 1.0}, T_world_bert = T_world_anna * explorers.between(0, 1);
  news["anna"].known_pose = KnownPose{T_world_anna, 0.0, 0.0, true};
  news["bert"].known_pose = KnownPose{T_world_bert, 0.0, 0.0, true};
  solver.take(std::move(news));
  EXPECT_EQ(status_of(solver.solve(Effort::full), "bert").T_world_map, T_world_bert);
  const SE2 T_new_old{5.0, 7.0, 2.0};
  OccupancyGrid map = explorers.map(1, 5);
  map.origin = T_new_old * map.origin;
  solver.take({{"bert", map_news(map)}});
  TeamAnswer answer = solver.solve(Effort::full);
  expect_at(answer, "bert", T_world_bert * inverse(T_new_old));
  EXPECT_FALSE(status_of(answer, "bert").has_known_pose);
  EXPECT_LT(status_of(answer, "bert").probability, 1.0);
  ASSERT_FALSE(answer.events.empty());
  EXPECT_EQ(answer.events[0].kind, TeamEvent::Kind::restarted);
  EXPECT_NE(answer.events[0].text.find("the pose given for it holds no longer"), std::string::npos);
  // With nothing in its new map it lies nowhere.
  solver.take({{"anna", map_news(make_grid(50, 50, 0.05))}});
  answer = solver.solve(Effort::full);
  EXPECT_FALSE(status_of(answer, "anna").has_known_pose);
  EXPECT_TRUE(answer.components.empty());
}

TEST(TeamSolverGroups, AKnownPoseOutlivesAMapThatIsBent) {
  const Explorers explorers;
  TeamSolver solver({});
  News news = news_at(explorers, 5, 2);
  const SE2 T_world_anna{100.0, 50.0, 1.0};
  news["anna"].known_pose = KnownPose{T_world_anna, 0.0, 0.0, true};
  solver.take(std::move(news));
  solver.solve(Effort::full);
  OccupancyGrid bent = explorers.map(0, 5);
  for (int row = bent.height - 1; row >= 12; --row) {
    for (int column = bent.width / 2; column < bent.width; ++column)
      bent.at(column, row) = bent.at(column, row - 12);
  }
  solver.take({{"anna", map_news(bent)}});
  const TeamAnswer answer = solver.solve(Effort::full);
  EXPECT_TRUE(has_event(answer, TeamEvent::Kind::restarted));
  EXPECT_TRUE(status_of(answer, "anna").has_known_pose);
}

}  // namespace
}  // namespace gridmerge::internal
