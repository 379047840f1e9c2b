// SPDX-License-Identifier: Apache-2.0
// Answers that say why there is no newer one.
#include <gtest/gtest.h>

#include <optional>
#include <string>
#include <utility>

#include "solver_news.hpp"

namespace gridmerge::internal {
namespace {

using Effort = TeamSolver::Effort;
using test::expect_at;
using test::expect_consistent;
using test::Explorers;
using test::gone_news;
using test::has_event;
using test::map_news;
using test::news_at;
using test::status_of;

/// Two fixed robots lie together however far apart they are.
News too_far_apart(const std::string& second = "bert") {
  News news;
  news["anna"].known_pose = KnownPose{{0.0, 0.0, 0.0}, 0.0, 0.0, true};
  news[second].known_pose = KnownPose{{9e6, 9e6, 0.0}, 0.0, 0.0, true};
  return news;
}

TEST(TeamSolverProblem, AMapTooLargeToMergeIsAProblemNotTheEnd) {
  const Explorers explorers;
  for (const Effort effort : {Effort::soon, Effort::further, Effort::full}) {
    TeamSolver solver({});
    solver.take(news_at(explorers, 5));
    const TeamAnswer before = solver.solve(Effort::full);
    EXPECT_EQ(before.problem, "");
    EXPECT_TRUE(before.settled);
    expect_consistent(before);
    News news = too_far_apart();
    solver.take(news);
    TeamAnswer answer = solver.solve(effort);
    EXPECT_NE(answer.problem, "");
    EXPECT_FALSE(answer.settled);
    EXPECT_EQ(answer.number, before.number + 1);
    EXPECT_TRUE(answer.events.empty());
    ASSERT_EQ(answer.components.size(), before.components.size());
    EXPECT_EQ(answer.components[0].map, before.components[0].map);
    ASSERT_EQ(answer.robots.size(), before.robots.size());
    for (const RobotStatus& robot : before.robots) {
      EXPECT_EQ(status_of(answer, robot.name).T_world_map, robot.T_world_map);
      EXPECT_EQ(status_of(answer, robot.name).component, robot.component);
    }
    expect_consistent(answer);
    news["bert"].known_pose = std::optional<KnownPose>();
    news["anna"].known_pose = std::optional<KnownPose>();
    solver.take(news);
    answer = solver.solve(Effort::full);
    EXPECT_EQ(answer.problem, "");
    EXPECT_TRUE(answer.settled);
    expect_consistent(answer);
  }
}

/// Who hears that it has none forgets the pose that he gave.
TEST(TeamSolverProblem, SaysWhichRobotsHaveAKnownPose) {
  const Explorers explorers;
  TeamSolver solver({});
  News news = news_at(explorers, 5);  // nothing was told of any of them before
  for (auto& [name, one] : too_far_apart()) add_news(news[name], std::move(one));
  solver.take(news);
  TeamAnswer answer = solver.solve(Effort::soon);
  EXPECT_NE(answer.problem, "");
  EXPECT_TRUE(status_of(answer, "anna").has_known_pose);
  EXPECT_TRUE(status_of(answer, "bert").has_known_pose);
  EXPECT_FALSE(status_of(answer, "carl").has_known_pose);
  news = {};
  news["bert"].known_pose = std::optional<KnownPose>();
  solver.take(news);
  answer = solver.solve(Effort::soon);
  EXPECT_EQ(answer.problem, "");
  // Of each of them something was told now.
  news = too_far_apart("carl");
  solver.take(news);
  answer = solver.solve(Effort::soon);
  EXPECT_NE(answer.problem, "");
  EXPECT_TRUE(status_of(answer, "anna").has_known_pose);
  EXPECT_FALSE(status_of(answer, "bert").has_known_pose);
  EXPECT_TRUE(status_of(answer, "carl").has_known_pose);
}

TEST(TeamSolverProblem, AnAnswerThatIsMadeAgainHasNoPosesOfMapsThatAreGone) {
  const Explorers explorers;
  TeamSolver solver({});
  solver.take(news_at(explorers, 5));
  ASSERT_EQ(solver.solve(Effort::full).components.size(), 1u);
  News news = too_far_apart("dora");
  news["carl"] = gone_news();
  add_news(news["carl"], map_news(explorers.map(2, 5), 9));
  add_news(news["dora"], map_news(explorers.map(3, 5), 10));
  solver.take(news);
  TeamAnswer answer = solver.solve(Effort::further);
  EXPECT_NE(answer.problem, "");
  expect_consistent(answer);
  for (const char* name : {"carl", "dora"}) {
    EXPECT_EQ(status_of(answer, name).state, RobotState::waiting);
    EXPECT_EQ(status_of(answer, name).why, "what was heard of it could not be merged yet");
    EXPECT_EQ(status_of(answer, name).maps_heard, 1u);
  }
  // In another frame, that a robot takes by itself.
  OccupancyGrid map = explorers.map(1, 4);
  map.origin = SE2{5.0, 7.0, 2.0} * map.origin;
  solver.take({{"bert", map_news(map, 1)}});
  answer = solver.solve(Effort::further);
  EXPECT_NE(answer.problem, "");
  EXPECT_EQ(status_of(answer, "bert").component, std::nullopt);
  EXPECT_TRUE(answer.events.empty());
  // Who is asked next tells what happened in between.
  news = {};
  news["anna"] = news["bert"] = gone_news();
  solver.take(news);
  answer = solver.solve(Effort::full);
  EXPECT_EQ(answer.problem, "");
  EXPECT_TRUE(has_event(answer, TeamEvent::Kind::left, "anna"));
  EXPECT_FALSE(has_event(answer, TeamEvent::Kind::restarted, "bert")) << "who is gone";
  expect_consistent(answer);
}

}  // namespace
}  // namespace gridmerge::internal
