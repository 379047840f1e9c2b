// SPDX-License-Identifier: Apache-2.0
// Maps that are given twice: they count once, and lie on each other where the cells say how.
#include <gtest/gtest.h>

#include <algorithm>
#include <optional>
#include <vector>

#include "grid/quarter_turned.hpp"
#include "gridmerge/merge/merge.hpp"
#include "merge/maps_left_out.hpp"
#include "merge/team.hpp"
#include "support/building.hpp"
#include "support/effort.hpp"

namespace gridmerge {

using test::Team;

namespace {

/// A map given again, from another frame and turned by a quarter, as a file that was saved twice may be.
OccupancyGrid saved_again(const OccupancyGrid& map) {
  OccupancyGrid copy = internal::quarter_turned(map, 1);
  copy.origin = SE2{4.0, -7.0, 0.4} * copy.origin;
  return copy;
}

/// Which looks different from each side.
OccupancyGrid small_map() {
  OccupancyGrid map = make_grid(4, 4, 0.1, {});
  for (std::size_t i = 0; i < map.cells.size(); ++i) map.cells[i] = i % 3 == 0 ? Cell::occupied : Cell::free;
  map.at(3, 3) = Cell::free;
  return map;
}

TEST(Merge, AMapThatIsJoinedToItsCopyAloneHoldsTheFrame) {
  const OccupancyGrid map = small_map();
  const std::vector<OccupancyGrid> maps{map, saved_again(map)};
  const MergeResult result = merge(maps);
  ASSERT_EQ(result.components.size(), 1U);
  ASSERT_EQ(result.components[0].members.size(), 2U);
  for (const Member& member : result.components[0].members) {
    ASSERT_TRUE(member.sd) << member.map;
    EXPECT_EQ(member.sd->position, 0.0);
    EXPECT_EQ(member.probability, 1.0);
  }
}

TEST(Merge, OfEqualMapsThatWithAKnownPoseIsTheOriginal) {
  const std::vector<OccupancyGrid> maps(3, small_map());
  for (std::size_t known = 0; known < maps.size(); ++known) {
    std::vector<std::optional<KnownPose>> poses(maps.size());
    poses[known] = KnownPose{{1.0, 2.0, 0.0}, 0.1, 0.1, true};
    const MergeResult result = merge(maps, {}, poses);
    ASSERT_EQ(result.components.size(), 1U) << known;
    EXPECT_EQ(result.components[0].members.size(), 3U) << known;
    for (const Member& member : result.components[0].members)
      EXPECT_EQ(member.T_component_map, (SE2{1.0, 2.0, 0.0})) << known;
  }
}

TEST(Merge, ACopyBeforeTheMapWhosePoseIsKnownHoldsTheFrame) {
  const Team team;
  const std::vector<OccupancyGrid> maps{saved_again(team.maps[0]), team.maps[0], team.maps[1]};
  std::vector<std::optional<KnownPose>> known(3);
  known[1] = KnownPose{{5.0, 1.0, 0.3}, 0.5, 0.05};
  const MergeResult result = merge(maps, {}, known), plain = merge(maps);
  ASSERT_EQ(result.components.size(), 1u);
  ASSERT_EQ(result.components[0].members.size(), 3u);
  EXPECT_EQ(result.components[0].members[0].T_component_map, SE2{});
  for (std::size_t i = 0; i < 3; ++i) {
    const SE2 &found = result.components[0].members[i].T_component_map,
              &expected = plain.components[0].members[i].T_component_map;
    EXPECT_NEAR(found.x, expected.x, 0.02) << i;
    EXPECT_NEAR(found.y, expected.y, 0.02) << i;
    EXPECT_NEAR(found.theta, expected.theta, 0.002) << i;
  }
  // The merged map is where its members are.
  const CellCounts one = count_cells(result.components[0].fused.grid),
                   other = count_cells(plain.components[0].fused.grid);
  EXPECT_NEAR(static_cast<double>(one.occupied), static_cast<double>(other.occupied),
              0.02 * static_cast<double>(other.occupied));
  const SE2 &a = result.components[0].fused.grid.origin, &b = plain.components[0].fused.grid.origin;
  EXPECT_NEAR(a.x, b.x, 0.2);
  EXPECT_NEAR(a.y, b.y, 0.2);
}

TEST(Merge, WhereACopyOfTwoKnownMapsLiesDoesNotDependOnTheirOrder) {
  OccupancyGrid map = make_grid(40, 30, 0.1, {}, Cell::free);
  for (int i = 0; i < 40; ++i) map.at(i, 0) = map.at(i, 29) = Cell::occupied;
  const std::vector<OccupancyGrid> maps(3, map);
  const KnownPose here{{}, 0.1, 0.1, true}, there{{100.0, 0.0, 0.0}, 0.1, 0.1, true};
  const auto place_of_the_third = [&](const KnownPose& first, const KnownPose& second) {
    const MergeResult result = merge(maps, {}, {first, second});
    for (const Component& component : result.components) {
      for (const Member& member : component.members) {
        if (member.map == 2) return member.T_component_map;
      }
    }
    return SE2{-1.0, -1.0, -1.0};
  };
  EXPECT_EQ(place_of_the_third(here, there), place_of_the_third(there, here));
}

TEST(Merge, AMapGivenTwiceCountsOnce) {
  Team team;
  const MergeResult once = merge(team.maps);
  team.expect_merged(once);
  for (std::size_t given_twice = 0; given_twice < test::repeats(4U, 1U); ++given_twice) {
    std::vector<OccupancyGrid> maps = team.maps;
    maps.push_back(saved_again(maps[given_twice]));
    const MergeResult twice = merge(maps);
    ASSERT_EQ(twice.components.size(), 1U);
    const std::vector<Member>& members = twice.components[0].members;
    ASSERT_EQ(members.size(), 5U);
    for (std::size_t i = 0; i < 4; ++i) {  // nothing else changes, not by a bit
      EXPECT_EQ(members[i].T_component_map, once.components[0].members[i].T_component_map);
      EXPECT_EQ(members[i].probability, once.components[0].members[i].probability);
    }
    EXPECT_EQ(twice.components[0].fused.grid.cells, once.components[0].fused.grid.cells);
    EXPECT_EQ(twice.expected_false_joins, once.expected_false_joins);
    EXPECT_EQ(twice.left_out, once.left_out);
    // It lies on its original: T_component_copy takes its middle where the original's goes.
    EXPECT_EQ(members[4].map, 5U);
    const SE2 T_original_copy = inverse(members[given_twice].T_component_map) * members[4].T_component_map;
    const SE2 expected = inverse(SE2{4.0, -7.0, 0.4});
    EXPECT_NEAR(T_original_copy.x, expected.x, 1e-9);
    EXPECT_NEAR(T_original_copy.y, expected.y, 1e-9);
    EXPECT_NEAR(normalize_angle(T_original_copy.theta - expected.theta), 0.0, 1e-9);
    // A join with every other map, as the original has one.
    ASSERT_EQ(twice.joins.size(), 15U);
    for (const Join& join : twice.joins) {
      EXPECT_LT(join.fixed, join.moving);
      if (join.moving != 5) continue;
      if (join.fixed == given_twice) {
        EXPECT_EQ(join.outcome, JoinOutcome::accepted);
        EXPECT_EQ(join.match.acceptance_index, 1.0);
        continue;
      }
      for (const Join& original : twice.joins) {
        if (std::minmax(original.fixed, original.moving) != std::minmax(join.fixed, given_twice)) continue;
        EXPECT_EQ(join.outcome, original.outcome);
        EXPECT_EQ(join.probability, original.probability);
        const SE2 T = join.T_fixed_moving * SE2{4.0, -7.0, 0.4};
        const SE2 of_original =
            original.fixed == join.fixed ? original.T_fixed_moving : inverse(original.T_fixed_moving);
        EXPECT_NEAR(T.x, of_original.x, 1e-9);
        EXPECT_NEAR(T.y, of_original.y, 1e-9);
      }
    }
  }
}

TEST(Merge, OfAMapAndItsCopiesIsThatMap) {
  const OccupancyGrid map = test::draw_building(1);
  const MergeResult result = merge({map, test::draw_building(2), saved_again(map), map});
  ASSERT_EQ(result.components.size(), 1U);
  EXPECT_EQ(result.components[0].members.size(), 3U);
  EXPECT_EQ(result.components[0].members[0].T_component_map, SE2{});
  EXPECT_EQ(result.components[0].members[2].T_component_map, SE2{});
  EXPECT_EQ(test::maps_left_out(result), std::vector<std::size_t>{1});
  EXPECT_EQ(result.joins.size(), 6U);
}

TEST(Merge, EmptyMapsAreNoCopiesOfEachOther) {
  const OccupancyGrid empty = make_grid(20, 20, 0.1, {}, Cell::free);
  EXPECT_TRUE(merge({empty, empty}).components.empty());
}

/// A hall with pillars that looks the same from its two ends.
OccupancyGrid symmetric_hall() {
  OccupancyGrid hall = make_grid(80, 50, 0.1, {}, Cell::free);
  const auto wall = [&](int left, int bottom, int right, int top) {
    for (int row = bottom; row < top; ++row) {
      for (int column = left; column < right; ++column)
        hall.at(column, row) = hall.at(79 - column, 49 - row) = Cell::occupied;
    }
  };
  wall(0, 0, 80, 2);
  wall(0, 0, 2, 50);
  wall(14, 10, 18, 14);
  wall(30, 8, 32, 20);
  return hall;
}

TEST(Merge, ATurnedCopyOfAMapThatLooksTheSameFromTwoSidesIsNotSure) {
  const OccupancyGrid hall = symmetric_hall();
  ASSERT_EQ(internal::quarter_turned(hall, 2).cells, hall.cells);
  const MergeResult result = merge({hall, saved_again(hall)});
  EXPECT_TRUE(result.components.empty());
  for (const Join& join : result.joins) EXPECT_LT(join.probability, 0.95);
  ASSERT_GE(result.open_ways.size(), 2U) << "two ways, of which none is better";
  // The same picture twice is one map, as before.
  const MergeResult beside = merge({hall, saved_again(hall), hall});
  ASSERT_EQ(beside.components.size(), 1U);
  EXPECT_EQ(test::maps_left_out(beside), std::vector<std::size_t>{1});
  EXPECT_EQ(beside.components[0].members[1].T_component_map, SE2{});
}

}  // namespace
}  // namespace gridmerge
