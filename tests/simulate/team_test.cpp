// SPDX-License-Identifier: Apache-2.0
#include "simulate/team.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <stdexcept>
#include <string>

namespace gridmerge {

using namespace internal;
namespace {

TEST(Overlap, IsNearEnoughByThreeHundredthsOrAnEighthOfWhatIsWanted) {
  EXPECT_TRUE(is_near_enough(0.5, 0.5));
  EXPECT_TRUE(is_near_enough(0.559, 0.5));
  EXPECT_TRUE(is_near_enough(0.441, 0.5));
  EXPECT_FALSE(is_near_enough(0.561, 0.5));
  EXPECT_FALSE(is_near_enough(0.439, 0.5));
  EXPECT_TRUE(is_near_enough(0.129, 0.1));
  EXPECT_TRUE(is_near_enough(0.071, 0.1));
  EXPECT_FALSE(is_near_enough(0.131, 0.1));
  EXPECT_FALSE(is_near_enough(0.069, 0.1));
  // None is none.
  EXPECT_TRUE(is_near_enough(0.0, 0.0));
  EXPECT_FALSE(is_near_enough(0.001, 0.0));
}

TEST(Overlap, ThatCannotBeHadIsToldWithTheNearestOne) {
  const std::string message = no_such_overlap(0.54321, 0.0123456).what();
  EXPECT_NE(message.find("an overlap of 0.543 cannot be had"), std::string::npos) << message;
  EXPECT_NE(message.find("the nearest is 0.0123"), std::string::npos) << message;
}

struct Floor {
  Floor() : building(make_building(BuildingKind::bare, 24.0, 16.0, 5)), plan(building.edges, 0.2) {}

  Team team(const SimulateOptions& options, std::uint64_t seed = 1) const {
    Random random(seed);
    return plan_team(options, building, plan, random);
  }

  Building building;
  FloorPlan plan;
};

SimulateOptions robots(int count) {
  SimulateOptions options;
  options.kind = BuildingKind::bare;
  options.width = 24.0;
  options.height = 16.0;
  options.robots = count;
  options.clutter = 0.0;
  return options;
}

TEST(Team, EachRobotHasItsErrand) {
  const Floor floor;
  SimulateOptions options = robots(3);
  options.longest_way = 7.5;
  options.scan_every = 0.4;
  options.sensor.range = 3.25;
  options.headings = {0.5, -0.5, 2.0};
  const Team team = floor.team(options);
  ASSERT_EQ(team.errands.size(), 3u);
  ASSERT_EQ(team.visits.size(), 3u);
  std::set<int> starts;
  for (std::size_t i = 0; i < 3; ++i) {
    const Errand& errand = team.errands[i];
    EXPECT_TRUE(floor.plan.is_free(errand.start));
    EXPECT_EQ(errand.longest_way, 7.5);
    EXPECT_EQ(errand.scan_every, 0.4);
    EXPECT_EQ(errand.sensor.range, 3.25);
    EXPECT_EQ(errand.heading, options.headings[i]);
    EXPECT_GT(errand.reach, 1e5);
    starts.insert(errand.start);
  }
  EXPECT_EQ(starts.size(), 3u);
  options.headings.clear();
  options.longest_way = 0.0;  // as far as it takes
  for (const Errand& errand : floor.team(options).errands) {
    EXPECT_GT(errand.longest_way, 1e5);
    EXPECT_FALSE(errand.heading);
  }
}

TEST(Team, StartsAreFarFromEachOther) {
  const Floor floor;
  Random random(3);
  double spread = 0.0, anywhere = 0.0;
  constexpr int kTeams = 40;
  const auto any = [&] {
    return floor.plan.free_cells()[static_cast<std::size_t>(random.pick(0, floor.plan.count_free() - 1))];
  };
  const auto apart = [&](int a, int b) {
    const Point2 p = floor.plan.centre(a), q = floor.plan.centre(b);
    return std::hypot(p.x - q.x, p.y - q.y) / kTeams;
  };
  for (std::uint64_t seed = 0; seed < kTeams; ++seed) {
    const Team team = floor.team(robots(2), seed);
    spread += apart(team.errands[0].start, team.errands[1].start);
    const int one = any();
    anywhere += apart(one, any());
  }
  // The farthest of six.
  EXPECT_GT(spread, 1.4 * anywhere);
}

TEST(Team, StartsMayBeHalfAMetreFromWhereARobotCanStand) {
  const Floor floor;
  // On the line from a free place in the middle to the right, the last place where a robot can stand.
  double x = 12.0;
  const auto is_free = [&](double at) {
    const int cell = floor.plan.cell_at({at, 8.0});
    return cell >= 0 && floor.plan.is_free(cell);
  };
  ASSERT_TRUE(is_free(x));
  while (is_free(x)) x += 0.01;
  SimulateOptions options = robots(1);
  options.starts = {{x + 0.3, 8.0}};
  EXPECT_EQ(floor.team(options).errands.size(), 1u);
  options.starts = {{x + 0.52, 8.0}};
  try {
    floor.team(options);
    FAIL() << "no robot can stand there";
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("no robot can stand at"), std::string::npos) << error.what();
  }
}

TEST(Team, ReachesAsFarAsTheOverlapTakes) {
  const Floor floor;
  SimulateOptions options = robots(2);
  options.starts = {{4.0, 8.0}, {20.0, 8.0}};
  options.sensor.range = 4.0;
  double last = 0.0;
  for (const double overlap : {0.1, 0.4, 0.8}) {
    options.overlap = overlap;
    const Team team = floor.team(options);
    EXPECT_EQ(team.errands[0].reach, team.errands[1].reach);
    EXPECT_GT(team.errands[0].reach, last) << overlap;
    EXPECT_LT(team.errands[0].reach, 40.0) << overlap;
    last = team.errands[0].reach;
  }
}

}  // namespace
}  // namespace gridmerge
