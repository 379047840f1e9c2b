// SPDX-License-Identifier: Apache-2.0
#include "gridmerge/merge/merge.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <random>
#include <stdexcept>

#include "gridmerge/grid/execution.hpp"
#include "gridmerge/merge/merger.hpp"
#include "merge/maps_left_out.hpp"
#include "merge/team.hpp"
#include "support/building.hpp"
#include "support/effort.hpp"

namespace gridmerge {

using test::expect_same;
using test::Team;

namespace {

/// The map on a large sheet that is black where the map knows nothing, as hand-edited maps are.
OccupancyGrid painted_black(const OccupancyGrid& map) {
  constexpr int kMargin = 150;
  OccupancyGrid sheet = make_grid(map.width + 2 * kMargin, map.height + 2 * kMargin, map.resolution,
                                  map.origin, Cell::occupied);
  for (int row = 0; row < map.height; ++row)
    for (int column = 0; column < map.width; ++column)
      if (map.at(column, row) != Cell::unknown)
        sheet.at(column + kMargin, row + kMargin) = map.at(column, row);
  return sheet;
}

TEST(Merge, PutsEveryMapWhereItBelongsAndLeavesOutTheStranger) {
  const Team team;
  const MergeResult result = merge(team.maps);
  team.expect_merged(result);
  EXPECT_EQ(result.joins.size(), 10u);
  EXPECT_EQ(result.left_out.size(), 1u);
  EXPECT_EQ(result.components[0].members[0].T_component_map, SE2{});
  for (const Member& member : result.components[0].members) {
    EXPECT_GE(member.probability.value(), 0.8);
    EXPECT_LT(member.sd.value().position, 1.0);
  }
  EXPECT_EQ(result.components[0].members[0].sd->position, 0.0);
  EXPECT_GT(result.components[0].members[1].sd->position, 0.0);
}

TEST(Merge, OfNoneOneOrTheSameMap) {
  const Team team;
  const MergeResult none = merge({});
  EXPECT_TRUE(none.components.empty() && none.joins.empty() && none.left_out.empty());
  EXPECT_EQ(test::maps_left_out(merge({team.maps[0]})), std::vector<std::size_t>{0});
  EXPECT_EQ(merge({team.maps[0]}).left_out.front().reason, Reason::nothing_to_compare);
  const MergeResult same = merge({team.maps[0], team.maps[0], team.maps[0]});
  ASSERT_EQ(same.components.size(), 1u);
  EXPECT_EQ(same.components[0].members.size(), 3u);
  for (const Member& member : same.components[0].members) EXPECT_EQ(member.T_component_map, SE2{});
  EXPECT_EQ(same.components[0].fused.conflicting, 0u);
}

// What became of each pair, and of which pose it speaks.
TEST(Merge, EachJoinSaysWhetherItWasBelievedByItself) {
  const Team team;
  const MergeResult result = merge(team.maps);
  std::size_t accepted = 0;
  for (const Join& join : result.joins) {
    const bool is_of_stranger = join.moving == 4;
    EXPECT_EQ(join.used(), !is_of_stranger) << join.fixed << ' ' << join.moving;
    if (!join.used()) continue;
    const bool is_believed =
        join.match.verdict == Verdict::accepted && join.T_fixed_moving == join.match.T_fixed_moving;
    EXPECT_EQ(join.outcome, is_believed ? JoinOutcome::accepted : JoinOutcome::rescued);
    accepted += is_believed ? 1 : 0;
  }
  EXPECT_GE(accepted, 3u);
}

TEST(Merge, OneMapInsideAnother) {
  const OccupancyGrid building = test::draw_building(1);
  const MergeResult result = merge({building, test::map_part(building, {3, 2, 13, 11}, {1.0, 2.0, 2.0})});
  ASSERT_EQ(result.components.size(), 1u);
  EXPECT_EQ(result.components[0].fused.grid.width, building.width);
}

TEST(Merge, ManyTinyMapsAreAllLeftOut) {
  std::vector<OccupancyGrid> maps;
  std::mt19937 random(1);
  const std::size_t count = test::repeats(100U, 25U);
  for (std::size_t i = 0; i < count; ++i) {
    OccupancyGrid map = make_grid(6, 6, 0.1, {}, Cell::free);
    for (Cell& cell : map.cells) cell = random() % 4 == 0 ? Cell::occupied : Cell::free;
    maps.push_back(std::move(map));
  }
  const MergeResult result = merge(maps);
  EXPECT_EQ(result.left_out.size(), count);
  EXPECT_EQ(result.joins.size(), count * (count - 1) / 2);
}

TEST(Merge, DoesNotDependOnThreads) {
  const Team team;
  MergeOptions one, four;
  one.match.threads = 1;
  four.match.threads = 4;
  expect_same(merge(team.maps, one), merge(team.maps, four));
}

TEST(Merge, OrderOfTheMapsDecidesNothingButTheFrame) {
  const Team team;
  std::vector<OccupancyGrid> reversed(team.maps.rbegin(), team.maps.rend());
  const MergeResult result = merge(reversed), usual = merge(team.maps);
  ASSERT_EQ(result.components.size(), 1u);
  EXPECT_EQ(test::maps_left_out(result), std::vector<std::size_t>{0});
  const auto pose = [](const MergeResult& of, std::size_t map) {
    const std::vector<Member>& members = of.components[0].members;
    return std::find_if(members.begin(), members.end(),
                        [&](const Member& member) { return member.map == map; })
        ->T_component_map;
  };
  for (std::size_t map = 1; map < 4; ++map) {
    const SE2 here = inverse(pose(result, 4)) * pose(result, 4 - map);
    const SE2 there = inverse(pose(usual, 0)) * pose(usual, map);
    EXPECT_NEAR(here.x, there.x, 1e-9);
    EXPECT_NEAR(here.y, there.y, 1e-9);
    EXPECT_NEAR(normalize_angle(here.theta - there.theta), 0.0, 1e-9);
  }
}

TEST(Merge, AKnownPoseJoinsMapsThatShareNothing) {
  const OccupancyGrid building = test::draw_building(1);
  const std::vector<OccupancyGrid> maps{test::map_part(building, {0, 0, 8, 13}, {}),
                                        test::map_part(building, {10, 0, 18, 13}, {})};
  EXPECT_EQ(merge(maps).left_out.size(), 2u);
  const KnownPose first{{5.0, 5.0, 0.0}, 0.1, 0.01}, second{{5.2, 5.0, 0.0}, 0.1, 0.01};
  const MergeResult result = merge(maps, {}, {first, second});
  ASSERT_EQ(result.components.size(), 1u);
  EXPECT_EQ(result.components[0].members[0].T_component_map, SE2{}) << "the frame is the first map's";
  EXPECT_NEAR(result.components[0].members[1].T_component_map.x, 0.2, 1e-6);
  EXPECT_EQ(result.joins[0].outcome, JoinOutcome::known);
}

TEST(Merge, AKnownPoseThatIsAboutRightIsImproved) {
  const Team team;
  std::vector<std::optional<KnownPose>> known(5);
  known[0] = KnownPose{team.T(0, 0) * SE2{0.5, 0.0, 0.0}, 1.0, 0.1};
  known[1] = KnownPose{team.T(0, 1) * SE2{0.0, -0.6, 0.03}, 1.0, 0.1};
  team.expect_merged(merge(team.maps, {}, known));
}

TEST(Merge, FixedPosesAreNotChangedAndMakeTheFrame) {
  const Team team;
  const SE2 T_world_first{100.0, 50.0, 1.0};
  std::vector<std::optional<KnownPose>> known(5);
  known[1] = KnownPose{T_world_first * team.T(0, 1), 0.0, 0.0, true};
  const MergeResult result = merge(team.maps, {}, known);
  team.expect_merged(result);
  EXPECT_EQ(result.components[0].members[1].T_component_map, known[1]->T_world_map);
  EXPECT_NEAR(result.components[0].members[0].T_component_map.x, T_world_first.x, 0.1);

  // Two that contradict what the maps say are taken for the truth all the same.
  known[0] = KnownPose{known[1]->T_world_map * SE2{30.0, 0.0, 0.0}, 0.0, 0.0, true};
  const MergeResult forced = merge({team.maps[0], team.maps[1]}, {}, {known[0], known[1]});
  ASSERT_EQ(forced.components.size(), 1u);
  EXPECT_EQ(forced.components[0].members[0].T_component_map, known[0]->T_world_map);
  EXPECT_EQ(forced.components[0].members[1].T_component_map, known[1]->T_world_map);
}

TEST(Merge, FixedMapsStayFixedWhateverOthersSay) {
  // Four maps of one place, all of which fit; two are fixed where they do not.
  const Team team;
  std::vector<std::optional<KnownPose>> known(4);
  known[0] = KnownPose{{0.0, 0.0, 0.0}, 0.0, 0.0, true};
  known[1] = KnownPose{{60.0, 0.0, 1.0}, 0.0, 0.0, true};
  const MergeResult result = merge({team.maps[0], team.maps[1], team.maps[2], team.maps[3]}, {}, known);
  ASSERT_GE(result.components.size(), 1u);
  const std::vector<Member>& members = result.components[0].members;
  ASSERT_GE(members.size(), 2u);
  EXPECT_TRUE(result.components[0].in_world_frame);
  EXPECT_EQ(members[0].T_component_map, known[0]->T_world_map);
  EXPECT_EQ(members[1].T_component_map, known[1]->T_world_map);
  EXPECT_NE(result.joins[0].outcome, JoinOutcome::accepted);
}

TEST(Merge, AVagueKnownPoseJoinsNoStrangers) {
  const Team team;
  const KnownPose vague{{0.0, 0.0, 0.0}, 1000.0, 3.0};
  EXPECT_EQ(merge({team.maps[0], team.maps[4]}, {}, {vague, vague}).left_out.size(), 2u);
}

TEST(Merge, AskingForNoProbabilityStillJoinsNothingUnproposed) {
  MergeOptions options;
  options.match.accept_probability = 0.0;
  const std::vector<OccupancyGrid> blank(2, make_grid(10, 10, 0.1));
  EXPECT_EQ(merge(blank, options).left_out.size(), 2u);
}

TEST(Merge, APairThatContradictsTheOthersIsRejectedByName) {
  // Where the third map is fixed, nothing of it fits the first two, though it does by itself.
  const Team team;
  std::vector<std::optional<KnownPose>> known(3);
  known[0] = KnownPose{{0.0, 0.0, 0.0}, 0.0, 0.0, true};
  known[2] = KnownPose{{200.0, 0.0, 0.0}, 0.0, 0.0, true};
  const MergeResult result = merge({team.maps[0], team.maps[1], team.maps[2]}, {}, known);
  EXPECT_EQ(result.joins[1].outcome, JoinOutcome::rejected);
  EXPECT_STREQ(name_of(result.joins[1].outcome), "rejected");
}

TEST(Merge, EndsBeforeItTakesMapsInWhenCancelled) {
  const std::atomic<bool> cancelled{true};
  const std::vector<OccupancyGrid> single{test::draw_building(1)};
  EXPECT_THROW(with_cancellation(cancelled, [&] { merge(single); }), Cancelled);
  Merger merger;
  EXPECT_THROW(with_cancellation(cancelled, [&] { merger.add(single[0]); }), Cancelled);
  EXPECT_TRUE(merger.maps().empty());
  const std::vector<PlacedMap> placed{{single.data(), {}}};
  EXPECT_THROW(with_cancellation(cancelled, [&] { fuse(placed, 0.05); }), Cancelled);
}

TEST(Merge, RefusesATransformThatThereIsNot) {
  MergeOptions options;
  options.transform = static_cast<MapTransform>(77);
  EXPECT_THROW(validate(options), std::invalid_argument);
}

TEST(Merge, RefusesWhatMakesNoSense) {
  const Team team;
  MergeOptions options;
  options.resolution = -1.0;
  EXPECT_THROW(merge(team.maps, options), std::invalid_argument);
  options.resolution = 0.0;
  options.match.accept_probability = 2.0;
  EXPECT_THROW(merge(team.maps, options), std::invalid_argument);
  const std::vector<OccupancyGrid> two{team.maps[0], team.maps[1]};
  for (const double sd : {-1.0, 0.0, 9e-7, 100001.0, 1e12, std::nan("")}) {
    EXPECT_THROW(merge(two, {}, {std::nullopt, KnownPose{{}, sd, 0.1}}), std::invalid_argument) << sd;
    EXPECT_THROW(merge(two, {}, {std::nullopt, KnownPose{{}, 0.1, sd}}), std::invalid_argument) << sd;
    EXPECT_NO_THROW(validate(KnownPose{{}, sd, sd, true})) << sd;
  }
  for (const double sd : {1e-6, 1e5}) EXPECT_NO_THROW(validate(KnownPose{{}, sd, sd})) << sd;
  EXPECT_THROW(merge(two, {}, {KnownPose{{std::nan(""), 0.0, 0.0}, 1.0, 0.1}}), std::invalid_argument);
  EXPECT_THROW(merge(two, {}, std::vector<std::optional<KnownPose>>(3)), std::invalid_argument);
  std::vector<OccupancyGrid> broken = two;
  broken[1].resolution = 0.0;
  try {
    merge(broken);
    FAIL() << "must throw";
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("map 1: "), std::string::npos) << error.what();
  }
}

TEST(Merge, BlackPaintHidesNothingThatOthersHaveSeen) {
  Team team;
  team.maps.pop_back();
  const MergeResult plain = merge(team.maps);
  team.maps[0] = painted_black(team.maps[0]);
  const MergeResult painted = merge(team.maps);
  ASSERT_EQ(painted.components.size(), 1U);
  ASSERT_EQ(painted.components[0].members.size(), 4U);
  const CellCounts with = count_cells(painted.components[0].fused.grid),
                   without = count_cells(plain.components[0].fused.grid);
  EXPECT_NEAR(static_cast<double>(with.free), static_cast<double>(without.free),
              0.02 * static_cast<double>(without.free));
  EXPECT_LT(with.occupied, 2 * without.occupied);
}

/// Two pieces of a corridor slide along it, whatever frame says so.
TEST(Merge, TheFreeDirectionTurnsWithTheFrame) {
  OccupancyGrid corridor = make_grid(400, 40, 0.05, {}, Cell::free);
  for (int x = 0; x < 400; ++x) corridor.at(x, 2) = corridor.at(x, 37) = Cell::occupied;
  OccupancyGrid piece = make_grid(200, 40, 0.05, SE2{3.0, 1.0, 0.5}, Cell::free);
  for (int x = 0; x < 200; ++x) piece.at(x, 2) = piece.at(x, 37) = Cell::occupied;
  const auto directions = [](const std::vector<OccupancyGrid>& maps) {
    const MergeResult result = merge(maps);
    return result.joins.at(0).match.hypotheses.at(0).figures.free_direction;
  };
  const auto off = [](double a, double b) { return std::abs(0.5 * normalize_angle(2.0 * (a - b))); };
  EXPECT_LT(off(directions({corridor, piece}), 0.0), 0.01);
  EXPECT_LT(off(directions({piece, corridor}), 0.5), 0.01);
}

TEST(Merge, SearchesNoScales) {
  MergeOptions options;
  options.match.scales = ScaleRange{0.5, 2.0};
  EXPECT_THROW(merge({}, options), std::invalid_argument);
}

}  // namespace
}  // namespace gridmerge
