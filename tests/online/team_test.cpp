// SPDX-License-Identifier: Apache-2.0
#include "gridmerge/online/team.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <future>
#include <iterator>
#include <mutex>
#include <stdexcept>
#include <thread>
#include <utility>

#include "explorers.hpp"
#include "patience.hpp"
#include "scarce_memory.hpp"
#include "support/effort.hpp"

namespace gridmerge {
namespace {

using namespace std::chrono_literals;
using test::Explorers;
using test::impatient;
using test::kLong;

const std::vector<std::string> kNames{"anna", "bert", "carl", "dora"};

TEST(Team, SettlesOnWhatMergeSaysHoweverFastMapsCome) {
  const Explorers explorers;
  const int count = test::repeats(4, 3);  // the fourth is a stranger
  TeamOptions options;
  options.quiet = 50ms;
  std::mutex mutex;
  std::vector<std::shared_ptr<const TeamAnswer>> answers;
  Team team(options, [&](const std::shared_ptr<const TeamAnswer>& answer) {
    const std::lock_guard lock(mutex);
    answers.push_back(answer);
  });
  std::vector<std::thread> robots;
  for (int robot = 0; robot < count; ++robot) {
    robots.emplace_back([&, robot] {
      for (int step = 1; step <= Explorers::kSteps; ++step) {
        team.hear(kNames[static_cast<std::size_t>(robot)], explorers.map(robot, step));
        std::this_thread::sleep_for(5ms);
      }
    });
  }
  for (std::thread& robot : robots) robot.join();
  ASSERT_TRUE(team.wait_until_settled(kLong));
  const auto answer = team.answer();
  std::vector<OccupancyGrid> maps;
  for (int robot = 0; robot < count; ++robot) maps.push_back(explorers.map(robot, Explorers::kSteps));
  const MergeResult merged = merge(maps);
  ASSERT_EQ(answer->components.size(), 1u);
  EXPECT_EQ(answer->components[0].robots, (std::vector<std::string>{"anna", "bert", "carl"}));
  EXPECT_EQ(merged.components[0].members.size(), 3u);
  const TeamMerge& behind = *answer->merge;
  ASSERT_EQ(behind.names.size(), static_cast<std::size_t>(count));
  ASSERT_EQ(behind.result.components.size(), 1u);
  EXPECT_EQ(behind.result.joins.size(), merged.joins.size());
  EXPECT_EQ(behind.result.left_out.size(), static_cast<std::size_t>(count) - 3);
  EXPECT_TRUE(behind.result.components[0].fused.grid.cells.empty());
  EXPECT_GT(behind.result.components[0].fused.agreeing, 10000u);
  for (const Member& member : behind.result.components[0].members) {
    const auto robot =
        std::find_if(answer->robots.begin(), answer->robots.end(),
                     [&](const RobotStatus& one) { return one.name == behind.names[member.map]; });
    ASSERT_NE(robot, answer->robots.end());
    EXPECT_EQ(member.T_component_map, robot->T_world_map);
    EXPECT_EQ(member.probability, robot->probability);
    const int number =
        static_cast<int>(std::find(kNames.begin(), kNames.end(), robot->name) - kNames.begin());
    EXPECT_EQ(behind.maps[member.map]->cells, explorers.map(number, Explorers::kSteps).cells);
  }
  const std::lock_guard lock(mutex);
  std::vector<std::string> told;
  for (std::size_t i = 0; i < answers.size(); ++i) {
    EXPECT_EQ(answers[i]->number, i + 1);
    for (const TeamEvent& event : answers[i]->events) told.push_back(event.text);
  }
  // Whoever asks at the end alone is told what all answers told.
  std::vector<std::string> taken;
  for (const TeamEvent& event : team.take_events()) taken.push_back(event.text);
  EXPECT_GE(taken.size(), 3u);
  EXPECT_EQ(taken, told);
  EXPECT_TRUE(team.take_events().empty());
  EXPECT_EQ(answers.back(), answer);
}

TEST(Team, PartsMakeTheSameMapAsAWhole) {
  const Explorers explorers;
  const OccupancyGrid whole = explorers.map(1, 5);
  TeamOptions options;
  options.quiet = 20ms;
  Team team(options);
  team.hear("anna", explorers.map(0, 5));
  team.hear("bert", make_grid(whole.width, whole.height, whole.resolution, whole.origin));
  const int half = whole.height / 2;
  for (const auto& [first, last] : {std::pair(0, half), std::pair(half, whole.height)}) {
    OccupancyGrid part = make_grid(whole.width, last - first, whole.resolution);
    std::copy_n(whole.cells.begin() + first * whole.width, part.cells.size(), part.cells.begin());
    EXPECT_TRUE(team.hear_part("bert", 0, first, part));
  }
  ASSERT_TRUE(team.wait_until_settled(kLong));
  Team other(options);
  other.hear("anna", explorers.map(0, 5));
  other.hear("bert", whole);
  ASSERT_TRUE(other.wait_until_settled(kLong));
  ASSERT_EQ(team.answer()->components.size(), 1u);
  EXPECT_EQ(team.answer()->components[0].map->cells, other.answer()->components[0].map->cells);
}

TEST(Team, PartsThatDoNotFitAreRefused) {
  Team team;
  const OccupancyGrid part = make_grid(4, 4, 0.05);
  EXPECT_FALSE(team.hear_part("anna", 0, 0, part));
  team.hear("anna", make_grid(8, 6, 0.05));
  EXPECT_TRUE(team.hear_part("anna", 4, 2, part));
  EXPECT_FALSE(team.hear_part("anna", 5, 2, part));
  EXPECT_FALSE(team.hear_part("anna", 4, 3, part));
  EXPECT_FALSE(team.hear_part("anna", -1, 0, part));
  EXPECT_FALSE(team.hear_part("anna", 2147483647, 0, part));
  OccupancyGrid broken = part;
  broken.cells.pop_back();
  EXPECT_THROW(team.hear_part("anna", 0, 0, broken), std::invalid_argument);
}

/// Work that goes on to its end has an answer. The end of a team is no moment for one, unless the two meet.
TEST(Team, EndsWhileItIsAtWork) {
  const Explorers explorers;
  const int robots[] = {0, 1, 3};  // a stranger last, at whom a second look is due
  const int rounds = test::repeats(20, 3);
  int late = 0;
  for (int i = 0; i < rounds; ++i) {
    std::promise<void> is_busy;
    std::atomic<bool> was_told = false;
    std::atomic<int> answers = 0;
    int answers_at_the_end = 0;
    {
      Team team({}, [&](const std::shared_ptr<const TeamAnswer>& answer) {
        ++answers;
        // Looks are left to be made, and are begun as soon as this returns.
        const bool goes_on = answer->robots.size() == std::size(robots) && !answer->settled;
        if (goes_on && !was_told.exchange(true)) is_busy.set_value();
      });
      for (const int robot : robots)
        team.hear(kNames[static_cast<std::size_t>(robot)], explorers.map(robot, 5));
      is_busy.get_future().wait();
      std::this_thread::sleep_for(std::chrono::milliseconds(1 + i % 5));
      answers_at_the_end = answers;
    }
    if (answers > answers_at_the_end) ++late;
  }
  EXPECT_LE(late, rounds / 3);
}

/// Thorough looks fail for want of memory, one as the other: nothing is gained by trying on and on.
TEST(Team, RestsWhereItsWorkFailsForGood) {
  if (!test::kMemoryCanBeScarce) GTEST_SKIP() << "memory is never scarce under ThreadSanitizer";
  std::vector<OccupancyGrid> strangers;  // more pairs of them than are looked at again at a time
  for (unsigned building = 1; building <= 4; ++building)
    strangers.push_back(test::map_part(test::draw_building(building), {0, 0, 9, 9}, {}));
  TeamOptions options;
  options.quiet = 20ms;
  std::atomic<int> failures = 0;
  std::atomic<bool> has_enough = true;
  Team team(options, [&](const std::shared_ptr<const TeamAnswer>& answer) {
    if (!answer->problem.empty()) ++failures;
    const bool all_were_looked_at_quickly = answer->robots.size() == strangers.size();
    if (all_were_looked_at_quickly && has_enough.exchange(false)) test::scarce_from = std::size_t{1} << 16;
  });
  for (std::size_t i = 0; i < strangers.size(); ++i) team.hear(kNames[i], strangers[i]);
  constexpr int kFarTooMany = 100;
  while (!team.is_at_rest() && failures < kFarTooMany) std::this_thread::sleep_for(1ms);
  std::this_thread::sleep_for(200ms);  // in which nothing comes any more
  test::scarce_from = 0;
  EXPECT_GE(failures, 1);
  EXPECT_LE(failures, 2);  // a further look, and all in full
  EXPECT_TRUE(team.is_at_rest());
  EXPECT_FALSE(team.wait_until_settled(0ms));
  EXPECT_NE(team.answer()->problem, "");
  EXPECT_FALSE(team.answer()->settled);
  // It is not the end: with memory and news it goes on from there.
  strangers[0].cells.front() = Cell::occupied;
  team.hear(kNames[0], strangers[0]);
  ASSERT_TRUE(team.wait_until_settled(kLong));
  EXPECT_EQ(team.answer()->problem, "");
  for (const RobotStatus& robot : team.answer()->robots) EXPECT_EQ(robot.state, RobotState::left_out);
}

TEST(Team, ForgetsRobots) {
  const Explorers explorers;
  TeamOptions options;
  options.quiet = 10ms;
  Team team(options);
  team.hear("anna", explorers.map(0, 5));
  team.hear("bert", explorers.map(1, 5));
  ASSERT_TRUE(team.wait_until_settled(kLong));
  EXPECT_EQ(team.answer()->components.size(), 1u);
  team.forget("bert");
  team.forget("nobody");
  ASSERT_TRUE(team.wait_until_settled(kLong));
  EXPECT_TRUE(team.answer()->components.empty());
  EXPECT_EQ(team.answer()->robots.size(), 1u);
}

TEST(Team, HoldsAKnownPoseFromWhenItIsToldUntilItIsTakenBack) {
  const Explorers explorers;
  TeamOptions options;
  options.quiet = 10ms;
  Team team(options);
  const SE2 told{100.0, 50.0, 1.0};
  const auto bert = [&] { return team.answer()->robots.at(1); };
  team.hear("anna", explorers.map(0, 5));
  team.hear("bert", explorers.map(1, 5));
  ASSERT_TRUE(team.wait_until_settled(kLong));
  ASSERT_EQ(bert().name, "bert");
  EXPECT_NE(bert().T_world_map, told);
  EXPECT_FALSE(team.take_events().empty());
  EXPECT_TRUE(team.take_events().empty()) << "each is taken once";
  team.set_known_pose("bert", KnownPose{told, 0.0, 0.0, true});
  ASSERT_TRUE(team.wait_until_settled(kLong));
  EXPECT_EQ(bert().T_world_map, told);
  EXPECT_EQ(team.answer()->components.at(0).anchor, "");
  team.set_known_pose("bert", std::nullopt);
  ASSERT_TRUE(team.wait_until_settled(kLong));
  EXPECT_EQ(team.answer()->components.at(0).anchor, "anna");
}

TEST(Team, HeedsNoAgeOfARobotThatWasNotHeard) {
  Team team(impatient());
  team.hear_age("anna", TeamTime{});
  team.hear("anna", make_grid(3, 3, 0.05));
  ASSERT_TRUE(team.wait_until_settled(kLong));
  ASSERT_EQ(team.answer()->robots.size(), 1u);
  EXPECT_NE(team.answer()->robots[0].heard_first, TeamTime{});
  team.hear_age("bert", TeamTime{});
  team.hear_age("anna", TeamTime{});
  ASSERT_TRUE(team.wait_until_settled(kLong));
  ASSERT_EQ(team.answer()->robots.size(), 1u) << "nobody has heard bert";
  EXPECT_EQ(team.answer()->robots[0].heard_first, TeamTime{});
}

TEST(Team, KeepsTheNewestThousandEventsThatNobodyTakes) {
  std::vector<std::string> told;
  Team team(impatient(), [&](const std::shared_ptr<const TeamAnswer>& answer) {
    for (const TeamEvent& event : answer->events) told.push_back(event.text);
  });
  team.hear("anna", make_grid(3, 3, 0.05, {}, Cell::free));
  team.hear("bert", make_grid(4, 4, 0.05, {}, Cell::free));
  team.set_known_pose("anna", KnownPose{{}, 0.0, 0.0, true});
  ASSERT_TRUE(team.wait_until_settled(kLong));
  for (int answers = 0; answers < 2000 && told.size() <= 1000; ++answers) {
    team.set_known_pose("bert", KnownPose{{3.0 * (answers % 2), 0.0, 0.0}, 0.0, 0.0, true});
    ASSERT_TRUE(team.wait_until_settled(kLong));  // and nothing is told meanwhile
  }
  ASSERT_GT(told.size(), 1000u);
  std::vector<std::string> taken;
  for (const TeamEvent& event : team.take_events()) taken.push_back(event.text);
  told.erase(told.begin(), told.end() - 1000);
  EXPECT_EQ(taken, told);
}

TEST(Team, SaysNothingOfWhereAForgottenMapLay) {
  const Explorers explorers;
  TeamOptions options;
  options.quiet = 10ms;
  Team team(options);
  team.hear("anna", explorers.map(0, 5));
  team.hear("bert", explorers.map(1, 5));
  ASSERT_TRUE(team.wait_until_settled(kLong));
  const auto bert = [&] {  // who is last, if there is one
    const auto answer = team.answer();
    return answer->robots.size() < 2 ? RobotStatus{} : answer->robots.at(1);
  };
  ASSERT_EQ(bert().state, RobotState::placed);
  // Work on what was heard before may be going on, and ends with an answer of its own.
  OccupancyGrid changed = explorers.map(0, 5), elsewhere = explorers.map(3, 5);  // of another building
  for (int i = 0; i < 5; ++i) {
    changed.cells[static_cast<std::size_t>(i)] = Cell::occupied;
    team.hear("anna", changed);
  }
  team.forget("bert");
  team.hear("bert", std::move(elsewhere));
  do {
    EXPECT_NE(bert().state, RobotState::placed);
    EXPECT_EQ(bert().component, std::nullopt);
  } while (!team.wait_until_settled(1ms));
  EXPECT_EQ(bert().state, RobotState::left_out);
}

TEST(Team, SaysThatWhatWasHeardOfAForgottenRobotIsBeingLookedAt) {
  TeamOptions options;
  options.quiet = 0ms;
  std::promise<void> is_told, goes_on;
  std::atomic<bool> is_held = false;
  Team team(options, [&](const std::shared_ptr<const TeamAnswer>& answer) {
    const bool is_second = !answer->robots.empty() && answer->robots.front().maps_heard == 2;
    if (!is_second || is_held.exchange(true)) return;
    is_told.set_value();
    goes_on.get_future().wait();  // until then the answer before is the newest
  });
  team.hear("anna", make_grid(3, 3, 0.05));
  ASSERT_TRUE(team.wait_until_settled(kLong));
  EXPECT_EQ(team.answer()->robots.at(0).why, "there is no other map yet");
  team.hear("anna", make_grid(3, 3, 0.05, {}, Cell::free));
  is_told.get_future().wait();
  team.forget("anna");
  team.hear("anna", make_grid(4, 4, 0.05));
  const auto answer = team.answer();
  goes_on.set_value();
  ASSERT_EQ(answer->robots.size(), 1u);
  EXPECT_EQ(answer->robots[0].name, "anna");
  EXPECT_EQ(answer->robots[0].state, RobotState::waiting);
  EXPECT_EQ(answer->robots[0].why, "it was forgotten, and what was heard since is being looked at");
  EXPECT_FALSE(answer->settled);
  ASSERT_TRUE(team.wait_until_settled(kLong));
  EXPECT_EQ(team.answer()->robots.at(0).why, "there is no other map yet");
}

TEST(Team, HasWhatItTellsWhenItTellsIt) {
  TeamOptions options;
  options.quiet = 0ms;
  std::atomic<Team*> its = nullptr;
  std::atomic<int> told = 0;
  const Explorers explorers;
  Team team(options, [&](const std::shared_ptr<const TeamAnswer>& answer) {
    EXPECT_EQ(its.load()->answer(), answer);
    EXPECT_EQ(its.load()->take_events().size(), answer->events.size());
    EXPECT_FALSE(its.load()->wait_until_settled(0ms)) << "this is work, too";
    ++told;
  });
  its = &team;
  team.hear("anna", explorers.map(0, 5));
  team.hear("bert", explorers.map(1, 5));
  ASSERT_TRUE(team.wait_until_settled(kLong));
  EXPECT_GT(told, 0);
}

TEST(Team, TellsNoPoseOfARobotThatWasForgottenMeanwhile) {
  const Explorers explorers;
  TeamOptions options;
  options.quiet = 0ms;
  std::atomic<bool> is_gone = false;
  std::atomic<int> placed_after = 0, told = 0;
  Team team(options, [&](const std::shared_ptr<const TeamAnswer>& answer) {
    ++told;
    for (const RobotStatus& robot : answer->robots)
      placed_after += is_gone && robot.name == "bert" && robot.state == RobotState::placed ? 1 : 0;
  });
  team.hear("anna", explorers.map(0, 5));
  team.hear("bert", explorers.map(1, 5));
  ASSERT_TRUE(team.wait_until_settled(kLong));
  OccupancyGrid changed = explorers.map(0, 5);
  for (int i = 0; i < 3; ++i) {  // work that has been cancelled once goes on to its end, so this is answered
    changed.at(i, 0) = Cell::occupied;
    team.hear("anna", changed);
    std::this_thread::sleep_for(2ms);
  }
  team.forget("bert");
  is_gone = true;
  ASSERT_TRUE(team.wait_until_settled(kLong));
  EXPECT_EQ(placed_after, 0);
}

TEST(Team, RefusesWhatMakesNoSense) {
  TeamOptions options;
  options.max_robots = 2;
  Team team(options);
  team.hear("anna", make_grid(3, 3, 0.05));
  team.hear("bert", make_grid(3, 3, 0.05));
  EXPECT_THROW(team.hear("carl", make_grid(3, 3, 0.05)), std::invalid_argument);
  team.forget("bert");
  team.hear("carl", make_grid(3, 3, 0.05));
  OccupancyGrid broken = make_grid(3, 3, 0.05);
  broken.resolution = -1.0;
  EXPECT_THROW(team.hear("anna", broken), std::invalid_argument);
  EXPECT_THROW(team.set_known_pose("anna", KnownPose{{}, -1.0, 0.1}), std::invalid_argument);

  const auto refuses = [](auto change) {
    TeamOptions bad;
    change(bad);
    EXPECT_THROW(validate(bad), std::invalid_argument);
    EXPECT_THROW(Team{bad}, std::invalid_argument);
  };
  refuses([](TeamOptions& o) { o.search_again = -0.1; });
  refuses([](TeamOptions& o) { o.confirmations = 0; });
  refuses([](TeamOptions& o) { o.quiet = -1ms; });
  TeamOptions restless;
  restless.quiet = 0ms;
  EXPECT_NO_THROW(validate(restless));
  refuses([](TeamOptions& o) { o.quiet = std::chrono::milliseconds::max(); });
  refuses([](TeamOptions& o) { o.quiet = std::chrono::hours(365 * 24) + 1ms; });
  refuses([](TeamOptions& o) { o.max_robots = 0; });
  refuses([](TeamOptions& o) { o.merge.transform = MapTransform::elastic; });
  refuses([](TeamOptions& o) { o.merge.max_false_joins = -1.0; });
  refuses([](TeamOptions& o) { o.merge.match.search = SearchMethod::random_walk; });
}

TEST(Team, WaitsForEverAndForNoTimeAtAll) {
  constexpr auto kEver = std::chrono::milliseconds::max();
  const Explorers explorers;
  TeamOptions options;
  options.quiet = std::chrono::hours(365 * 24);
  Team team(options);
  EXPECT_TRUE(team.wait_until_settled(kEver));  // nothing was heard
  team.hear("anna", explorers.map(0, 5));
  EXPECT_TRUE(team.wait_until_settled(kEver));
  // A little of it changes: nothing is searched before it is quiet, which it is in a year.
  OccupancyGrid changed = explorers.map(0, 5);
  changed.cells.front() = Cell::occupied;
  team.hear("anna", changed);
  EXPECT_FALSE(team.wait_until_settled(kEver.min()));
  const auto has_answered = [&] { return team.answer()->robots.at(0).maps_heard == 2; };
  while (!has_answered()) std::this_thread::sleep_for(1ms);
  EXPECT_FALSE(team.wait_until_settled(20ms));
  EXPECT_FALSE(team.is_at_rest());
  // To wait for ever is to wait, not to find that the time is over.
  std::atomic<bool> is_over = false;
  std::thread waits([&] {
    EXPECT_TRUE(team.wait_until_settled(kEver));
    is_over = true;
  });
  std::this_thread::sleep_for(50ms);
  EXPECT_FALSE(is_over);
  team.forget("anna");
  waits.join();
}

}  // namespace
}  // namespace gridmerge
