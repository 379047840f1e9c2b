// SPDX-License-Identifier: Apache-2.0
// Small changes of placed maps: they are drawn where the robot lies, and weighed later.
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <thread>

#include "explorers.hpp"
#include "gridmerge/grid/execution.hpp"
#include "gridmerge/merge/fuse.hpp"
#include "gridmerge/merge/merge.hpp"
#include "online/robot_map.hpp"
#include "online/solver.hpp"
#include "solver_news.hpp"

namespace gridmerge::internal {
namespace {

using Effort = TeamSolver::Effort;
using test::expect_consistent;
using test::Explorers;
using test::map_news;
using test::news_at;
using test::status_of;

/// Something stands where there was none, and walls are gone, in a box near the middle of what is known.
OccupancyGrid refurnished(OccupancyGrid map, int size = 4) {
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

/// Free cells of the top are not known any more.
void forget(OccupancyGrid& map, std::size_t cells) {
  for (std::size_t i = map.cells.size(); i > 0 && cells > 0; --i) {
    if (map.cells[i - 1] != Cell::free) continue;
    map.cells[i - 1] = Cell::unknown;
    --cells;
  }
}

News news_of(const std::string& robot, const OccupancyGrid& map) {
  News news;
  news[robot] = map_news(map, 1);
  return news;
}

/// The maps that an answer says it is of, as it places them.
std::vector<PlacedMap> placed_by(const TeamAnswer& answer, std::size_t component) {
  std::vector<PlacedMap> placed;
  for (const Member& member : answer.merge->result.components.at(component).members)
    placed.push_back({answer.merge->maps.at(member.map).get(), member.T_component_map});
  return placed;
}

void expect_drawn(const TeamAnswer& answer) {
  expect_consistent(answer);
  ASSERT_FALSE(answer.components.empty());
  for (std::size_t i = 0; i < answer.components.size(); ++i) {
    const OccupancyGrid& map = *answer.components[i].map;
    const FusedMap expected = fuse(placed_by(answer, i), map.resolution);
    const FusedMap& found = answer.merge->result.components[i].fused;
    EXPECT_EQ(map.cells, expected.grid.cells);
    EXPECT_EQ(map.origin, expected.grid.origin);
    EXPECT_EQ(found.agreeing, expected.agreeing);
    EXPECT_EQ(found.conflicting, expected.conflicting);
    ASSERT_TRUE(found.omega && expected.omega);
    EXPECT_EQ(found.omega->equal, expected.omega->equal);
  }
}

class DrawnChanges : public testing::Test {
 protected:
  DrawnChanges() {
    solver_.take(news_at(explorers_, 5));
    before_ = solver_.solve(Effort::full);
  }

  /// Says what comes of a newer map of bert's.
  TeamAnswer hear(const OccupancyGrid& map) {
    solver_.take(news_of("bert", map));
    return solver_.solve(Effort::soon);
  }

  const Explorers explorers_;
  TeamSolver solver_{{}};
  TeamAnswer before_;
};

/// A team that has searched all, and searches a map anew from such a change on.
TeamSolver searched_team(const Explorers& explorers, double search_again) {
  TeamOptions options;
  options.search_again = search_again;
  TeamSolver solver(options);
  solver.take(news_at(explorers, 5));
  solver.solve(Effort::full);
  return solver;
}

TEST_F(DrawnChanges, ShowAtOnceAndAreWeighedLater) {
  ASSERT_EQ(before_.components.at(0).robots.size(), 3u);
  const OccupancyGrid map = refurnished(explorers_.map(1, 5));
  ASSERT_NE(map.cells, explorers_.map(1, 5).cells);
  const TeamAnswer answer = hear(map);
  EXPECT_FALSE(answer.settled) << "the pose does not follow from this map yet";
  EXPECT_EQ(status_of(answer, "bert").maps_heard, 2u);
  for (const RobotStatus& robot : before_.robots) {
    EXPECT_EQ(status_of(answer, robot.name).T_world_map, robot.T_world_map);
    EXPECT_EQ(status_of(answer, robot.name).probability, robot.probability);
  }
  EXPECT_NE(answer.components.at(0).map->cells, before_.components[0].map->cells);
  EXPECT_EQ(answer.merge->maps.at(1)->cells, map.cells);
  expect_drawn(answer);
  // In the end it is as if that map alone had been heard.
  const TeamAnswer later = solver_.solve(Effort::full);
  EXPECT_TRUE(later.settled);
  TeamSolver fresh({});
  News all = news_at(explorers_, 5);
  all["bert"] = map_news(map, 1);
  fresh.take(all);
  EXPECT_EQ(later.components[0].map->cells, fresh.solve(Effort::full).components.at(0).map->cells);
  EXPECT_EQ(solver_.solve(Effort::soon).components[0].map, later.components[0].map) << "nothing is new";
}

TEST_F(DrawnChanges, AreMuchInTheEnd) {
  OccupancyGrid map = explorers_.map(1, 5);
  const std::size_t known = count_cells(map).known();
  const auto pose_after = [&](std::size_t cells) {
    forget(map, cells);
    return status_of(hear(map), "bert").T_world_map;
  };
  const SE2 first = status_of(before_, "bert").T_world_map;
  EXPECT_EQ(pose_after(known / 100), first) << "1 %";
  EXPECT_EQ(pose_after(known / 200), first) << "1.5 %";
  EXPECT_NE(pose_after(known / 100), first) << "2.5 %";
}

/// Walls are a small part of what is known, and the poses follow from them.
TEST_F(DrawnChanges, OfWallsAreMuchSooner) {
  OccupancyGrid map = explorers_.map(1, 5);
  const std::size_t known = count_cells(map).known();
  std::size_t gone = 0;
  for (Cell& cell : map.cells) {
    if (cell != Cell::occupied || 100 * gone >= known) continue;
    cell = Cell::free;
    ++gone;
  }
  EXPECT_NE(status_of(hear(map), "bert").T_world_map, status_of(before_, "bert").T_world_map);
}

TEST_F(DrawnChanges, FollowOneAnother) {
  hear(refurnished(explorers_.map(1, 5)));
  const OccupancyGrid map = refurnished(explorers_.map(1, 5), 6);
  const TeamAnswer answer = hear(map);
  EXPECT_EQ(answer.merge->maps.at(1)->cells, map.cells) << "the newest counts";
  EXPECT_FALSE(answer.settled);
  expect_drawn(answer);
}

TEST_F(DrawnChanges, OfAllMapsAreDrawnAtOnce) {
  News news;
  const auto& names = before_.merge->names;
  for (std::size_t i = 0; i < names.size(); ++i)
    news[names[i]] = map_news(refurnished(*before_.merge->maps[i]), static_cast<int>(i));
  solver_.take(news);
  const TeamAnswer answer = solver_.solve(Effort::soon);
  EXPECT_FALSE(answer.settled);
  expect_drawn(answer);
}

TEST_F(DrawnChanges, ThatAreTakenBackLeaveNothingToDo) {
  EXPECT_FALSE(hear(refurnished(explorers_.map(1, 5))).settled);
  const TeamAnswer answer = hear(explorers_.map(1, 5));
  EXPECT_TRUE(answer.settled);
  EXPECT_EQ(answer.components.at(0).map->cells, before_.components.at(0).map->cells);
}

TEST_F(DrawnChanges, AreForgottenWithTheirRobot) {
  hear(refurnished(explorers_.map(1, 5)));
  News news;
  news["bert"].is_gone = true;
  solver_.take(news);
  const TeamAnswer answer = solver_.solve(Effort::soon);
  EXPECT_EQ(answer.robots.size(), 2u);
  EXPECT_EQ(answer.components.at(0).robots.size(), 2u);
  expect_consistent(answer);
  EXPECT_TRUE(solver_.solve(Effort::full).settled);
}

TEST_F(DrawnChanges, AreWeighedWithAKnownPose) {
  hear(refurnished(explorers_.map(1, 5)));
  News news;
  news["anna"].known_pose = std::optional<KnownPose>(KnownPose{{1.0, 2.0, 0.5}, 0.0, 0.0, true});
  solver_.take(news);
  expect_drawn(solver_.solve(Effort::soon));
  const TeamAnswer answer = solver_.solve(Effort::full);
  EXPECT_EQ(status_of(answer, "anna").T_world_map, (SE2{1.0, 2.0, 0.5}));
  expect_drawn(answer);
}

TEST_F(DrawnChanges, AreKeptWhereMoreIsLookedAt) {
  const TeamAnswer drawn = hear(refurnished(explorers_.map(1, 5)));
  const TeamAnswer further = solver_.solve(Effort::further);
  EXPECT_EQ(further.components.at(0).map->cells, drawn.components.at(0).map->cells);
  expect_drawn(further);
}

TEST_F(DrawnChanges, OfOneOfTwoEqualMaps) {
  solver_.take(news_of("copy", explorers_.map(1, 5)));
  const TeamAnswer both = solver_.solve(Effort::full);
  ASSERT_EQ(both.components.at(0).robots.size(), 4u);
  expect_drawn(hear(refurnished(explorers_.map(1, 5))));
}

/// Equal maps count once, whichever other map changes.
TEST_F(DrawnChanges, BesideTwoEqualMaps) {
  const OccupancyGrid map = explorers_.map(1, 5);
  OccupancyGrid padded = make_grid(map.width + 7, map.height + 5, map.resolution, map.origin);
  for (int row = 0; row < map.height; ++row) {
    for (int column = 0; column < map.width; ++column) padded.at(column, row) = map.at(column, row);
  }
  for (const OccupancyGrid& copy : {map, padded}) {
    solver_.take(news_of("copy", copy));
    ASSERT_EQ(solver_.solve(Effort::full).components.at(0).robots.size(), 4u);
    solver_.take(news_of("anna", refurnished(explorers_.map(0, 5))));
    const TeamAnswer answer = solver_.solve(Effort::soon);
    std::vector<PlacedMap> distinct;
    const std::vector<PlacedMap> all = placed_by(answer, 0);
    for (const PlacedMap& one : all) {
      if (one.map != answer.merge->maps.at(3).get()) distinct.push_back(one);
    }
    ASSERT_EQ(distinct.size(), 3u);
    const FusedMap expected = fuse(distinct, answer.components.at(0).map->resolution);
    EXPECT_EQ(answer.components[0].map->cells, expected.grid.cells);
    EXPECT_EQ(answer.merge->result.components.at(0).fused.agreeing, expected.agreeing);
    solver_.take(news_of("anna", explorers_.map(0, 5)));
    solver_.solve(Effort::full);
  }
}

/// What was weighed and not searched, and what is drawn, add up.
TEST(DrawnChangesOfATeam, CountWithWhatWasNotSearchedYet) {
  const Explorers explorers;
  TeamSolver solver = searched_team(explorers, 0.05);
  OccupancyGrid map = explorers.map(1, 5);
  const std::size_t known = count_cells(map).known();
  const auto is_searched_after = [&](double share) {
    forget(map, static_cast<std::size_t>(share * static_cast<double>(known)));
    solver.take(news_of("bert", map));
    solver.solve(Effort::soon);
    solver.solve(Effort::further);
    return solver.is_settled();
  };
  EXPECT_FALSE(is_searched_after(0.04));
  EXPECT_TRUE(is_searched_after(0.015)) << "5.5 % since it was searched, 1.5 % since it was weighed";
}

TEST(DrawnChangesOfATeam, AreSearchedWhereEveryChangeIs) {
  const Explorers explorers;
  TeamSolver solver = searched_team(explorers, 0.0);
  solver.take(news_of("bert", refurnished(explorers.map(1, 5))));
  solver.solve(Effort::further);
  EXPECT_TRUE(solver.is_settled());
}

/// While a place is contradicted, small changes confirm that, as others do.
TEST(DrawnChangesOfATeam, ConfirmWhatContradictsAPlace) {
  const Explorers explorers;
  TeamSolver solver({});
  News news;
  news["anna"] = map_news(explorers.map(0, 5), 0);
  solver.take(news);
  OccupancyGrid map = explorers.map(1, 5);
  const auto hear = [&] {
    solver.take(news_of("bert", map));
    solver.solve(Effort::soon);
    return status_of(solver.solve(Effort::further), "bert").state == RobotState::placed;
  };
  ASSERT_TRUE(hear());
  // It knows less and less of what they share, until that is too little.
  const int strip = map.width / 20;
  for (int column = 0; merge({explorers.map(0, 5), map}).components.size() == 1; column += strip) {
    ASSERT_TRUE(hear());
    ASSERT_LT(column, map.width);
    for (int i = column; i < std::min(column + strip, map.width); ++i) {
      for (int row = 0; row < map.height; ++row) map.at(i, row) = Cell::unknown;
    }
  }
  ASSERT_TRUE(hear()) << "it is not confirmed yet";
  int answers = 1;
  do {
    map = refurnished(map, 1);
    ++answers;
  } while (hear() && answers < 10);
  EXPECT_LE(answers, TeamOptions().confirmations + 1);
}

/// A map that is repeated cancels work as any other does. What was not done yet is still to be done.
TEST(DrawnChangesOfATeam, CancelledWorkIsNotSettled) {
  const Explorers explorers;
  News strangers = news_at(explorers, 2, 4);
  strangers.erase("bert");
  strangers.erase("carl");
  for (const Effort effort : {Effort::further, Effort::full}) {
    std::size_t cancelled = 0, unsettled = 0;
    for (auto wait = std::chrono::milliseconds(1);; wait *= 3) {
      TeamSolver solver({});
      solver.take(strangers);
      solver.solve(Effort::soon);
      std::atomic<bool> flag = false;
      std::thread stops([&] {
        std::this_thread::sleep_for(wait);
        flag = true;
      });
      bool is_done = true;
      try {
        with_cancellation(flag, [&] { solver.solve(effort); });
      } catch (const Cancelled&) {
        is_done = false;
        ++cancelled;
      }
      stops.join();
      if (is_done) break;
      News repeated;
      repeated["anna"] = map_news(explorers.map(0, 2));
      solver.take(repeated);
      const TeamAnswer answer = solver.solve(Effort::soon);
      expect_consistent(answer);
      unsettled += answer.settled ? 0 : 1;  // the last of these may have been cancelled when all was done
    }
    EXPECT_GT(unsettled, 0u);
    EXPECT_GE(unsettled + 1, cancelled);
  }
}

TEST(CountChangedCells, TellsWallsApart) {
  const OccupancyGrid before = make_grid(6, 5, 0.1, {}, Cell::free);
  OccupancyGrid after = before;
  after.at(1, 1) = Cell::occupied;
  after.at(4, 3) = Cell::unknown;
  const auto changed = count_changed_cells(before, after);
  EXPECT_EQ(changed->all, 2u);
  EXPECT_EQ(changed->walls, 1u);
  EXPECT_EQ(count_changed_cells(after, before)->walls, 1u);
  EXPECT_EQ(count_changed_cells(before, before)->all, 0u);
  EXPECT_FALSE(count_changed_cells(before, make_grid(6, 6, 0.1, {}, Cell::free)));
}

}  // namespace
}  // namespace gridmerge::internal
