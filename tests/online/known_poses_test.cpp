// SPDX-License-Identifier: Apache-2.0
// A known pose is of the frame that the robot's map had when it was given.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <future>
#include <memory>
#include <optional>
#include <string>

#include "gridmerge/grid/execution.hpp"
#include "patience.hpp"
#include "scarce_memory.hpp"
#include "solver_news.hpp"

namespace gridmerge::internal {
namespace {

using Effort = TeamSolver::Effort;
using test::expect_consistent;
using test::Explorers;
using test::has_event;
using test::map_news;
using test::news_at;
using test::status_of;

RobotNews pose_news(const SE2& pose) {
  RobotNews news;
  news.known_pose = KnownPose{pose, 0.0, 0.0, true};
  return news;
}

/// Two robots of which one starts anew, with fixed poses.
class KnownPoses : public testing::Test {
 protected:
  /// As it is after so many restarts.
  OccupancyGrid bert_in(int frame) const {
    OccupancyGrid map = explorers.map(1, 5);
    for (int i = 0; i < frame; ++i) map.origin = T_new_old * map.origin;
    return map;
  }

  SE2 T_world_bert_in(int frame) const {
    SE2 pose = T_world_anna * explorers.between(0, 1);
    for (int i = 0; i < frame; ++i) pose = pose * inverse(T_new_old);
    return pose;
  }

  /// Of both robots, which have poses.
  News begin() const {
    News news = news_at(explorers, 5, 2);
    add_news(news["anna"], pose_news(T_world_anna));
    add_news(news["bert"], pose_news(T_world_bert_in(0)));
    return news;
  }

  void solve_first(TeamSolver& solver) const {
    solver.take(begin());
    ASSERT_EQ(status_of(solver.solve(Effort::full), "bert").T_world_map, T_world_bert_in(0));
  }

  static bool says_lost(const TeamAnswer& answer) {
    return std::any_of(answer.events.begin(), answer.events.end(), [](const TeamEvent& event) {
      return event.text.find("the pose given for it holds no longer") != std::string::npos;
    });
  }

  Explorers explorers;
  const SE2 T_new_old{5.0, 7.0, 2.0};
  const SE2 T_world_anna{100.0, 50.0, 1.0};
};

TEST_F(KnownPoses, AreOfTheMapThatWasHeardBefore) {
  for (const bool together : {true, false}) {
    TeamSolver solver({});
    solve_first(solver);
    RobotNews news = map_news(bert_in(1));
    if (together) {
      add_news(news, pose_news(T_world_bert_in(1)));
    } else {
      solver.take({{"bert", news}});
      news = pose_news(T_world_bert_in(1));
    }
    solver.take({{"bert", news}});
    const TeamAnswer answer = solver.solve(Effort::full);
    EXPECT_TRUE(has_event(answer, TeamEvent::Kind::restarted, "bert"));
    EXPECT_FALSE(says_lost(answer)) << "there is a newer one";
    EXPECT_TRUE(status_of(answer, "bert").has_known_pose);
    EXPECT_EQ(status_of(answer, "bert").T_world_map, T_world_bert_in(1));
    EXPECT_EQ(status_of(answer, "bert").maps_heard, 2u);
    expect_consistent(answer);
  }
}

TEST_F(KnownPoses, AreLostWithALaterMapThatStartsAnew) {
  for (const int frame : {0, 1}) {  // that of the map before the pose
    TeamSolver solver({});
    solve_first(solver);
    RobotNews news = map_news(bert_in(frame));
    add_news(news, pose_news(T_world_bert_in(frame)));
    add_news(news, map_news(bert_in(frame + 1)));
    solver.take({{"bert", news}});
    const TeamAnswer answer = solver.solve(Effort::full);
    EXPECT_FALSE(status_of(answer, "bert").has_known_pose);
    EXPECT_TRUE(says_lost(answer));
    EXPECT_LT(status_of(answer, "bert").probability, 1.0);
  }
}

TEST_F(KnownPoses, OfTheFirstMapComeBeforeOrAfterIt) {
  for (const bool pose_first : {true, false}) {
    const RobotNews map = map_news(explorers.map(1, 5)), pose = pose_news(T_world_bert_in(0));
    News news = begin();
    news["bert"] = pose_first ? pose : map;
    add_news(news["bert"], pose_first ? map : pose);
    TeamSolver solver({});
    solver.take(news);
    const TeamAnswer answer = solver.solve(Effort::full);
    EXPECT_EQ(status_of(answer, "bert").T_world_map, T_world_bert_in(0));
    EXPECT_EQ(status_of(answer, "bert").heard_first, TeamTime{});
    EXPECT_FALSE(has_event(answer, TeamEvent::Kind::restarted, "bert"));
  }
}

TEST_F(KnownPoses, AreOfAMapWhoseWeighingWasCancelled) {
  TeamSolver solver({});
  solve_first(solver);
  solver.take({{"bert", map_news(bert_in(1))}});
  const std::atomic<bool> at_once = true;
  EXPECT_THROW(with_cancellation(at_once, [&] { solver.solve(Effort::full); }), Cancelled);
  solver.take({{"bert", pose_news(T_world_bert_in(1))}});
  const TeamAnswer answer = solver.solve(Effort::full);
  EXPECT_FALSE(says_lost(answer));
  EXPECT_EQ(status_of(answer, "bert").T_world_map, T_world_bert_in(1));
}

TEST_F(KnownPoses, AreKeptWhereTheNewMapWasNotTaken) {
  if (!test::kMemoryCanBeScarce) GTEST_SKIP() << "memory is never scarce under ThreadSanitizer";
  TeamSolver solver({});
  solve_first(solver);
  OccupancyGrid map = make_grid(80000, 4, 0.05);  // too large for walls to be compared
  map.at(0, 0) = Cell::occupied;
  solver.take({{"bert", map_news(map)}});
  test::scarce_from = map.cells.size() * sizeof(Cell);  // there is room for no copy of it
  TeamAnswer answer = solver.solve(Effort::soon);
  test::scarce_from = 0;
  EXPECT_NE(answer.problem, "");
  EXPECT_TRUE(status_of(answer, "bert").has_known_pose);
  solver.take({{"bert", map_news(bert_in(0))}});
  answer = solver.solve(Effort::full);
  EXPECT_TRUE(answer.events.empty());
  EXPECT_EQ(status_of(answer, "bert").T_world_map, T_world_bert_in(0));
}

TEST_F(KnownPoses, ThatCameSinceAreNotSaidToBeLost) {
  TeamSolver solver({});
  solve_first(solver);
  // So far away that nothing can be told of the map that starts anew.
  const SE2 far{9e6, 9e6, 0.0};
  solver.take({{"bert", map_news(bert_in(1))}, {"carl", map_news(explorers.map(2, 5))}});
  solver.take({{"carl", pose_news(far)}});
  ASSERT_NE(solver.solve(Effort::soon).problem, "");
  News news{{"bert", pose_news(T_world_bert_in(1))}};
  news["carl"].known_pose = std::optional<KnownPose>();
  solver.take(news);
  const TeamAnswer answer = solver.solve(Effort::full);
  EXPECT_EQ(answer.problem, "");
  EXPECT_TRUE(has_event(answer, TeamEvent::Kind::restarted, "bert"));
  EXPECT_FALSE(says_lost(answer));
  EXPECT_EQ(status_of(answer, "bert").T_world_map, T_world_bert_in(1));
}

/// A part is drawn into a map that waits, and may make another one of it.
TEST_F(KnownPoses, AreOfTheMapWithoutPartsThatComeLater) {
  std::promise<void> is_busy, goes_on;
  std::atomic<bool> is_held = false;
  Team team(test::impatient(), [&](const std::shared_ptr<const TeamAnswer>&) {
    if (is_held.exchange(true)) return;
    is_busy.set_value();
    goes_on.get_future().wait();  // until then whatever is heard waits
  });
  team.hear("anna", explorers.map(0, 5));
  is_busy.get_future().wait();
  OccupancyGrid map = explorers.map(1, 5);
  team.hear("bert", map);
  team.set_known_pose("bert", KnownPose{T_world_bert_in(0), 0.0, 0.0, true});
  std::fill(map.cells.begin(), map.cells.end(), Cell::unknown);
  EXPECT_TRUE(team.hear_part("bert", 0, 0, map));
  goes_on.set_value();
  ASSERT_TRUE(team.wait_until_settled(test::kLong));
  const auto answer = team.answer();
  EXPECT_EQ(answer->merge->maps.at(1)->cells, map.cells);
  EXPECT_FALSE(status_of(*answer, "bert").has_known_pose);
}

}  // namespace
}  // namespace gridmerge::internal
