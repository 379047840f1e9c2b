// SPDX-License-Identifier: Apache-2.0
#include "online/solver.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <thread>

#include "explorers.hpp"
#include "gridmerge/grid/execution.hpp"
#include "solver_news.hpp"

namespace gridmerge::internal {
namespace {

using Effort = TeamSolver::Effort;
using test::expect_at;
using test::Explorers;
using test::gone_news;
using test::has_event;
using test::kNames;
using test::map_news;
using test::news_at;
using test::status_of;

TEST(TeamSolver, ExplorersComeTogetherAndTheStrangerDoesNot) {
  const Explorers explorers;
  TeamSolver solver({});
  for (int step = 1; step <= Explorers::kSteps; ++step) {
    solver.take(news_at(explorers, step, 4));
    const TeamAnswer answer = solver.solve(Effort::further);
    EXPECT_EQ(answer.number, static_cast<std::uint64_t>(step));
    for (const RobotStatus& robot : answer.robots) {
      EXPECT_FALSE(has_event(answer, TeamEvent::Kind::jumped, robot.name));
      EXPECT_EQ(robot.maps_heard, static_cast<std::uint64_t>(step));
    }
    EXPECT_EQ(status_of(answer, "dora").state, RobotState::left_out);
    // Whoever is placed is placed rightly.
    for (int robot = 1; robot < 3; ++robot) {
      const std::string& name = kNames[static_cast<std::size_t>(robot)];
      if (status_of(answer, name).component && answer.components[0].anchor == "anna")
        expect_at(answer, name, explorers.between(0, robot), 0.8);
    }
  }
  const TeamAnswer answer = solver.solve(Effort::full);
  ASSERT_EQ(answer.components.size(), 1u);
  EXPECT_EQ(answer.components[0].robots, (std::vector<std::string>{"anna", "bert", "carl"}));
  EXPECT_EQ(answer.components[0].anchor, "anna");
  EXPECT_TRUE(answer.settled);
}

/// At the end of all news the answer is merge()'s, to the cell.
TEST(TeamSolver, ASettledAnswerIsThatOfMerge) {
  const Explorers explorers;
  TeamOptions options;
  options.search_again = 0.6;  // so that much is left to be searched
  TeamSolver solver(options);
  for (int step = 2; step <= Explorers::kSteps; ++step) {
    solver.take(news_at(explorers, step, 4));
    solver.solve(Effort::further);
  }
  EXPECT_FALSE(solver.is_settled());
  const TeamAnswer answer = solver.solve(Effort::full);
  EXPECT_TRUE(answer.settled);
  std::vector<OccupancyGrid> maps;
  for (int robot = 0; robot < 4; ++robot) maps.push_back(explorers.map(robot, Explorers::kSteps));
  const MergeResult merged = merge(maps);
  ASSERT_EQ(answer.components.size(), merged.components.size());
  EXPECT_EQ(answer.components[0].map->cells, merged.components[0].fused.grid.cells);
  EXPECT_EQ(answer.components[0].map->origin, merged.components[0].fused.grid.origin);
  for (const Member& member : merged.components[0].members) {
    const RobotStatus& robot = status_of(answer, kNames[member.map]);
    EXPECT_EQ(robot.T_world_map, member.T_component_map);
    EXPECT_EQ(robot.probability, member.probability);
  }
  EXPECT_EQ(status_of(answer, "dora").reason, merged.left_out.at(0).reason);
}

/// Soon and further come to the same as all at once.
TEST(TeamSolver, AnAnswerThatComesSoonIsCompletedLater) {
  const Explorers explorers;
  TeamSolver bit_by_bit({}), at_once({});
  bit_by_bit.take(news_at(explorers, 2, 4));
  at_once.take(news_at(explorers, 2, 4));
  TeamAnswer answer = bit_by_bit.solve(Effort::soon);
  EXPECT_FALSE(answer.settled);
  int answers = 1;
  while (!bit_by_bit.is_complete()) {
    answer = bit_by_bit.solve(Effort::further);
    ++answers;
  }
  EXPECT_GT(answers, 1);
  EXPECT_TRUE(answer.settled);
  const TeamAnswer expected = at_once.solve(Effort::full);
  ASSERT_EQ(answer.components.size(), expected.components.size());
  for (std::size_t i = 0; i < expected.robots.size(); ++i) {
    EXPECT_EQ(answer.robots[i].state, expected.robots[i].state);
    EXPECT_EQ(answer.robots[i].T_world_map, expected.robots[i].T_world_map);
    EXPECT_EQ(answer.robots[i].probability, expected.robots[i].probability);
  }
}

TEST(TeamSolver, ALittleChangeIsFollowedWithoutASearch) {
  const Explorers explorers;
  TeamSolver solver({});
  solver.take(news_at(explorers, 5));
  solver.solve(Effort::further);
  // One map loses a strip: what it knows is nearly the same.
  OccupancyGrid map = explorers.map(1, 5);
  for (int row = 0; row < map.height / 50; ++row) {
    for (int column = 0; column < map.width; ++column) map.at(column, row) = Cell::unknown;
  }
  News news;
  news["bert"] = map_news(map, 1);
  solver.take(news);
  EXPECT_FALSE(solver.is_settled());
  const TeamAnswer followed = solver.solve(Effort::further);
  EXPECT_FALSE(followed.settled);
  expect_at(followed, "bert", explorers.between(0, 1));
  EXPECT_TRUE(solver.solve(Effort::full).settled);
}

TEST(TeamSolver, ARobotThatStartsAnewIsPlacedInItsNewFrame) {
  const Explorers explorers;
  TeamSolver solver({});
  solver.take(news_at(explorers, 5));
  expect_at(solver.solve(Effort::further), "bert", explorers.between(0, 1));
  const SE2 T_new_old{5.0, 7.0, 2.0};
  OccupancyGrid map = explorers.map(1, 4);
  News news;
  map.origin = T_new_old * map.origin;
  news["bert"] = map_news(map, 1);
  solver.take(news);
  const TeamAnswer answer = solver.solve(Effort::further);
  EXPECT_TRUE(has_event(answer, TeamEvent::Kind::restarted, "bert"));
  EXPECT_FALSE(has_event(answer, TeamEvent::Kind::jumped, "bert"));
  expect_at(answer, "bert", explorers.between(0, 1) * inverse(T_new_old));
}

/// A robot whose map keeps saying that it is elsewhere is believed, but not at once.
TEST(TeamSolver, WhoLeavesIsTakenOutWhenThatIsConfirmed) {
  const Explorers explorers;
  TeamOptions options;
  options.confirmations = 2;
  TeamSolver solver(options);
  News news;
  news["anna"] = map_news(explorers.map(0, 5), 0);
  news["bert"] = map_news(explorers.map(1, 5), 1);
  solver.take(news);
  EXPECT_EQ(solver.solve(Effort::further).components.size(), 1u);
  // The other floor, in a frame that looks the same to change_between(): it forgets bit by bit.
  OccupancyGrid map = explorers.map(1, 5);
  int answers = 0;
  for (int part = 1;
       part <= 9 && status_of(solver.solve(Effort::further), "bert").state == RobotState::placed; ++part) {
    for (int row = 0; row < map.height; ++row) {
      for (int column = map.width * (part - 1) / 10; column < map.width * part / 10; ++column)
        map.at(column, row) = Cell::unknown;
    }
    News less;
    less["bert"] = map_news(map, 1);
    solver.take(less);
    ++answers;
  }
  EXPECT_GT(answers, 2);
  EXPECT_FALSE(solver.is_settled() && status_of(solver.solve(Effort::further), "bert").component);
}

TEST(TeamSolver, TheFrameIsThatOfTheRobotHeardFirstForAsLongAsItLives) {
  const Explorers explorers;
  TeamSolver solver({});
  News news;
  news["carl"] = map_news(explorers.map(2, 5), 10);
  news["bert"] = map_news(explorers.map(1, 5), 20);
  solver.take(news);
  TeamAnswer answer = solver.solve(Effort::further);
  EXPECT_EQ(answer.components.at(0).anchor, "carl");
  // Outputs take the first map for the one that holds the frame, unless they are told otherwise.
  EXPECT_EQ(answer.merge->names.at(0), "bert");
  EXPECT_TRUE(answer.merge->result.components.at(0).in_world_frame);
  news = {};
  news["anna"] = map_news(explorers.map(0, 5), 30);
  solver.take(news);
  answer = solver.solve(Effort::further);
  EXPECT_EQ(answer.components.at(0).anchor, "carl");
  EXPECT_EQ(status_of(answer, "carl").T_world_map, SE2{});
  expect_at(answer, "anna", explorers.between(2, 0));
  // Another node has heard bert before.
  news = {};
  news["bert"].since = TeamTime(std::chrono::seconds(5));
  solver.take(news);
  answer = solver.solve(Effort::further);
  EXPECT_EQ(answer.components.at(0).anchor, "bert");
  EXPECT_FALSE(answer.merge->result.components.at(0).in_world_frame);
  expect_at(answer, "anna", explorers.between(1, 0));
  EXPECT_TRUE(answer.events.empty());  // a frame is not a jump
  news = {};
  news["bert"].is_gone = true;
  solver.take(news);
  answer = solver.solve(Effort::further);
  EXPECT_TRUE(has_event(answer, TeamEvent::Kind::left, "bert"));
  EXPECT_EQ(answer.components.at(0).anchor, "carl");
}

TEST(TeamSolver, NothingIsLeftOfARobotThatIsHeardAndForgottenAtOnce) {
  const Explorers explorers;
  TeamSolver solver({});
  News news;
  RobotNews& anna = news["anna"];
  add_news(anna, map_news(explorers.map(0, 3)));
  RobotNews known;
  known.known_pose = KnownPose{{1.0, 2.0, 0.0}, 0.0, 0.0, true};
  add_news(anna, known);
  add_news(anna, gone_news());
  solver.take(news);
  EXPECT_TRUE(solver.solve(Effort::full).robots.empty());
  // News of one robot may wait in the solver too.
  for (const RobotNews& one : {map_news(explorers.map(0, 3)), gone_news()}) solver.take({{"anna", one}});
  EXPECT_TRUE(solver.solve(Effort::full).robots.empty());
}

TEST(TeamSolver, ARobotThatComesBackIsAsOldAsItsNewMap) {
  const Explorers explorers;
  TeamSolver solver({});
  News news;
  news["bert"] = map_news(explorers.map(1, 5), 20);
  RobotNews& anna = news["anna"];
  for (int step = 3; step <= 5; ++step) add_news(anna, map_news(explorers.map(0, step), 10));
  RobotNews known;
  known.known_pose = KnownPose{{1.0, 2.0, 0.0}, 0.0, 0.0, true};
  add_news(anna, known);
  add_news(anna, gone_news());
  add_news(anna, map_news(explorers.map(0, 5), 30));
  solver.take(news);
  const TeamAnswer answer = solver.solve(Effort::full);
  EXPECT_EQ(status_of(answer, "anna").heard_first, TeamTime(std::chrono::seconds(30)));
  EXPECT_EQ(status_of(answer, "anna").maps_heard, 1u);
  ASSERT_EQ(answer.components.size(), 1u);
  EXPECT_EQ(answer.components[0].anchor, "bert");
}

TEST(TeamSolver, NewsAndOrderGiveTheSameAnswer) {
  const Explorers explorers;
  TeamSolver together({}), apart({});
  together.take(news_at(explorers, 4));
  const TeamAnswer expected = together.solve(Effort::full);
  for (const int robot : {2, 0, 1}) {
    News news;
    news[kNames[static_cast<std::size_t>(robot)]] = map_news(explorers.map(robot, 4), robot);
    apart.take(news);
    apart.solve(Effort::further);
  }
  const TeamAnswer answer = apart.solve(Effort::full);
  ASSERT_EQ(answer.components.size(), expected.components.size());
  EXPECT_EQ(answer.components[0].robots, expected.components[0].robots);
  EXPECT_EQ(answer.components[0].anchor, expected.components[0].anchor);
  for (const RobotStatus& robot : expected.robots) {
    if (robot.component) expect_at(answer, robot.name, robot.T_world_map);
  }
}

TEST(TeamSolver, ACancelledAnswerLosesNothing) {
  const Explorers explorers;
  TeamSolver solver({}), undisturbed({});
  solver.take(news_at(explorers, 5));
  undisturbed.take(news_at(explorers, 5));
  const TeamAnswer expected = undisturbed.solve(Effort::further);
  std::size_t cancelled = 0;
  // Ever later, so that it is cancelled everywhere.
  for (auto wait = std::chrono::microseconds(0);; wait = wait * 2 + std::chrono::microseconds(200)) {
    std::atomic<bool> flag = false;
    std::thread stops([&] {
      std::this_thread::sleep_for(wait);
      flag = true;
    });
    try {
      with_cancellation(flag, [&] {
        const TeamAnswer answer = solver.solve(Effort::further);
        stops.join();
        EXPECT_EQ(answer.components.at(0).map->cells, expected.components.at(0).map->cells);
        EXPECT_EQ(answer.number, 1u);
        EXPECT_EQ(answer.robots.size(), 3u);
        for (const RobotStatus& robot : answer.robots) EXPECT_EQ(robot.maps_heard, 1u);
      });
      break;
    } catch (const Cancelled&) {
      stops.join();
      ++cancelled;
    }
  }
  EXPECT_GT(cancelled, 0u);
}

TEST(TeamSolver, KnownPosesHoldTheFrame) {
  const Explorers explorers;
  TeamSolver solver({});
  News news = news_at(explorers, 5);
  news["bert"].known_pose = KnownPose{{100.0, 50.0, 1.0}, 0.0, 0.0, true};
  solver.take(news);
  const TeamAnswer answer = solver.solve(Effort::further);
  EXPECT_EQ(answer.components.at(0).anchor, "");
  EXPECT_EQ(status_of(answer, "bert").T_world_map, (SE2{100.0, 50.0, 1.0}));
  expect_at(answer, "anna", SE2{100.0, 50.0, 1.0} * explorers.between(1, 0));
}

TEST(TeamSolver, SaysWhatItWaitsFor) {
  const Explorers explorers;
  TeamSolver solver({});
  News news;
  news["anna"] = map_news(explorers.map(0, 3));
  news["bert"].known_pose = std::optional<KnownPose>();
  solver.take(news);
  const TeamAnswer answer = solver.solve(Effort::further);
  EXPECT_EQ(status_of(answer, "anna").state, RobotState::waiting);
  EXPECT_EQ(status_of(answer, "anna").why, "there is no other map yet");
  EXPECT_EQ(status_of(answer, "bert").why, "no map came yet");
  EXPECT_TRUE(answer.components.empty());
}

}  // namespace
}  // namespace gridmerge::internal
