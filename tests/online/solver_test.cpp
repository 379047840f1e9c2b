// SPDX-License-Identifier: Apache-2.0
#include "online/solver.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <stdexcept>
#include <thread>

#include "explorers.hpp"
#include "gridmerge/grid/cancellation.hpp"
#include "gridmerge/grid/resample.hpp"
#include "gridmerge/merge/fuse.hpp"

namespace gridmerge::internal {
namespace {

using test::Explorers;

using Effort = TeamSolver::Effort;

const std::vector<std::string> kNames{"anna", "bert", "carl", "dora"};

RobotNews map_news(OccupancyGrid map, int second = 0) {
  RobotNews news;
  news.map = std::make_shared<const OccupancyGrid>(std::move(map));
  news.maps_heard = 1;
  news.since = TeamTime(std::chrono::seconds(second));
  return news;
}

/// The maps of the first robots at a moment, heard in the order of their names. The fourth is a stranger.
News news_at(const Explorers& explorers, int step, int robots = 3) {
  News news;
  for (int robot = 0; robot < robots; ++robot)
    news[kNames[static_cast<std::size_t>(robot)]] = map_news(explorers.map(robot, step), robot);
  return news;
}

const RobotStatus& status_of(const TeamAnswer& answer, const std::string& name) {
  for (const RobotStatus& robot : answer.robots) {
    if (robot.name == name) return robot;
  }
  throw std::out_of_range(name);
}

/// With less in common maps are placed less exactly.
void expect_at(const TeamAnswer& answer, const std::string& name, const SE2& expected,
               double tolerance = 0.15) {
  const RobotStatus& robot = status_of(answer, name);
  EXPECT_EQ(robot.state, RobotState::placed) << name << ": " << robot.why;
  EXPECT_NEAR(robot.T_world_map.x, expected.x, tolerance) << name;
  EXPECT_NEAR(robot.T_world_map.y, expected.y, tolerance) << name;
  EXPECT_NEAR(normalize_angle(robot.T_world_map.theta - expected.theta), 0.0, tolerance / 8.0) << name;
}

bool has_event(const TeamAnswer& answer, TeamEvent::Kind kind, const std::string& robot) {
  return std::any_of(answer.events.begin(), answer.events.end(),
                     [&](const TeamEvent& event) { return event.kind == kind && event.robot == robot; });
}

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

/// Something stands where there was none, and walls are gone, in a box near the middle of what is known.
OccupancyGrid refurnished(OccupancyGrid map, int size) {
  std::size_t known = 0;
  const std::size_t middle = count_cells(map).known() / 2;
  int column = 0, row = 0;
  for (int y = 0; y < map.height && known < middle; ++y) {
    for (int x = 0; x < map.width && known < middle; ++x) {
      if (map.at(x, y) != Cell::unknown) ++known;
      column = x;
      row = y;
    }
  }
  for (int y = row; y < std::min(row + size, map.height); ++y) {
    for (int x = column; x < std::min(column + size, map.width); ++x)
      map.at(x, y) = map.at(x, y) == Cell::occupied ? Cell::free : Cell::occupied;
  }
  return map;
}

/// Draws what a robot's newest map says where the robot lies.
TEST(TeamSolver, ALittleChangeIsDrawnAtOnceAndWeighedLater) {
  const Explorers explorers;
  TeamSolver solver({});
  solver.take(news_at(explorers, 5));
  const TeamAnswer before = solver.solve(Effort::further);
  ASSERT_EQ(before.components.at(0).robots.size(), 3u);
  const OccupancyGrid map = refurnished(explorers.map(1, 5), 8);
  ASSERT_NE(map.cells, explorers.map(1, 5).cells);
  News news;
  news["bert"] = map_news(map, 1);
  solver.take(news);
  const TeamAnswer answer = solver.solve(Effort::soon);
  EXPECT_FALSE(answer.settled) << "the pose does not follow from this map yet";
  EXPECT_EQ(status_of(answer, "bert").maps_heard, 2u);
  ASSERT_EQ(answer.components.size(), before.components.size());
  std::vector<PlacedMap> placed;
  for (const std::string& name : answer.components[0].robots) {
    EXPECT_EQ(status_of(answer, name).T_world_map, status_of(before, name).T_world_map);
    EXPECT_EQ(status_of(answer, name).probability, status_of(before, name).probability);
    const auto at = std::find(answer.merge->names.begin(), answer.merge->names.end(), name);
    placed.push_back({answer.merge->maps.at(static_cast<std::size_t>(at - answer.merge->names.begin())).get(),
                      status_of(answer, name).T_world_map});
  }
  const FusedMap expected = fuse(placed, explorers.map(0, 5).resolution);
  EXPECT_EQ(answer.components[0].map->cells, expected.grid.cells);
  EXPECT_NE(answer.components[0].map->cells, before.components[0].map->cells);
  EXPECT_EQ(answer.merge->result.components[0].fused.agreeing, expected.agreeing);
  EXPECT_EQ(answer.merge->maps.at(1)->cells, map.cells);
  // In the end it is as if that map alone had been heard.
  const TeamAnswer later = solver.solve(Effort::full);
  EXPECT_TRUE(later.settled);
  TeamSolver fresh({});
  News all = news_at(explorers, 5);
  all["bert"] = map_news(map, 1);
  fresh.take(all);
  EXPECT_EQ(later.components[0].map->cells, fresh.solve(Effort::full).components.at(0).map->cells);
  EXPECT_EQ(solver.solve(Effort::soon).components[0].map->cells, later.components[0].map->cells);
}

/// Little by little is much in the end.
TEST(TeamSolver, ManyLittleChangesAreWeighedTogether) {
  const Explorers explorers;
  TeamSolver solver({});
  solver.take(news_at(explorers, 5));
  solver.solve(Effort::full);
  OccupancyGrid map = explorers.map(1, 5);
  const std::size_t known = count_cells(map).known();
  const auto forget = [&](std::size_t cells) {  // from the top
    for (std::size_t i = map.cells.size(); i > 0 && cells > 0; --i) {
      if (map.cells[i - 1] == Cell::unknown) continue;
      map.cells[i - 1] = Cell::unknown;
      --cells;
    }
  };
  const auto pose_after = [&](std::size_t cells) {
    forget(cells);
    News news;
    news["bert"] = map_news(map, 1);
    solver.take(news);
    return status_of(solver.solve(Effort::soon), "bert").T_world_map;
  };
  const SE2 first = pose_after(known / 100);
  EXPECT_EQ(first, pose_after(known / 200)) << "1.5 %";
  EXPECT_NE(first, pose_after(known / 100)) << "2.5 %";
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
  EXPECT_EQ(solver.solve(Effort::further).components.at(0).anchor, "carl");
  news = {};
  news["anna"] = map_news(explorers.map(0, 5), 30);
  solver.take(news);
  TeamAnswer answer = solver.solve(Effort::further);
  EXPECT_EQ(answer.components.at(0).anchor, "carl");
  EXPECT_EQ(status_of(answer, "carl").T_world_map, SE2{});
  expect_at(answer, "anna", explorers.between(2, 0));
  // Another node has heard bert before.
  news = {};
  news["bert"].since = TeamTime(std::chrono::seconds(5));
  solver.take(news);
  answer = solver.solve(Effort::further);
  EXPECT_EQ(answer.components.at(0).anchor, "bert");
  expect_at(answer, "anna", explorers.between(1, 0));
  EXPECT_TRUE(answer.events.empty());  // a frame is not a jump
  news = {};
  news["bert"].is_gone = true;
  solver.take(news);
  answer = solver.solve(Effort::further);
  EXPECT_TRUE(has_event(answer, TeamEvent::Kind::left, "bert"));
  EXPECT_EQ(answer.components.at(0).anchor, "carl");
}

RobotNews gone_news() {
  RobotNews news;
  news.is_gone = true;
  return news;
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

/// Two fixed robots lie together however far apart they are.
News too_far_apart() {
  News news;
  news["anna"].known_pose = KnownPose{{0.0, 0.0, 0.0}, 0.0, 0.0, true};
  news["bert"].known_pose = KnownPose{{9e6, 9e6, 0.0}, 0.0, 0.0, true};
  return news;
}

/// Components and robots tell one story, whichever of the two is read.
void expect_consistent(const TeamAnswer& answer) {
  for (const RobotStatus& robot : answer.robots) {
    EXPECT_EQ(robot.state == RobotState::placed, robot.component.has_value()) << robot.name;
    if (!robot.component) continue;
    const std::vector<std::string>& members = answer.components.at(*robot.component).robots;
    EXPECT_EQ(std::count(members.begin(), members.end(), robot.name), 1) << robot.name;
    for (const Component& component : answer.merge->result.components) {
      for (const Member& member : component.members) {
        if (answer.merge->names.at(member.map) != robot.name) continue;
        EXPECT_EQ(member.T_component_map, robot.T_world_map) << robot.name;
      }
    }
  }
}

TEST(TeamSolver, AMapTooLargeToMergeIsAProblemNotTheEnd) {
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

TEST(TeamSolver, AnAnswerThatIsMadeAgainHasNoPosesOfMapsThatAreGone) {
  const Explorers explorers;
  TeamSolver solver({});
  solver.take(news_at(explorers, 5));
  ASSERT_EQ(solver.solve(Effort::full).components.size(), 1u);
  News news = too_far_apart();
  news["carl"] = gone_news();
  add_news(news["carl"], map_news(explorers.map(2, 5), 9));
  news["dora"] = map_news(explorers.map(3, 5), 10);
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
  expect_consistent(answer);
}

}  // namespace
}  // namespace gridmerge::internal
