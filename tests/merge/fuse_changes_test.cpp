// SPDX-License-Identifier: Apache-2.0
#include "merge/fuse_changes.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cstdint>
#include <numbers>
#include <utility>

#include "grid/equal_grids.hpp"
#include "merge/drawing.hpp"

namespace gridmerge::internal {
namespace {

/// Numbers with few digits, so that cells meet often at their sides.
double some(int low, int high) {
  return *rc::gen::inRange(4 * low, 4 * high + 1) / 4.0;
}

OccupancyGrid some_map() {
  const double resolution = *rc::gen::elementOf(std::vector<double>{0.05, 0.1, 0.25});
  OccupancyGrid map = make_grid(*rc::gen::inRange(1, 40), *rc::gen::inRange(1, 40), resolution,
                                {some(-3, 3), some(-3, 3), some(-3, 3)});
  const auto any = rc::gen::weightedElement<Cell>({{2, Cell::unknown}, {3, Cell::free}, {1, Cell::occupied}});
  map.cells = *rc::gen::container<std::vector<Cell>>(map.cells.size(), any);
  if (*rc::gen::inRange(0, 3) == 0) {
    for (const Cell cell : map.cells)
      map.probability.push_back(cell == Cell::occupied ? 0.75f : cell == Cell::free ? 0.25f : 0.5f);
  }
  return map;
}

std::vector<PlacedMap> placed(const std::vector<OccupancyGrid>& maps, const std::vector<SE2>& poses) {
  std::vector<PlacedMap> placed;
  for (std::size_t i = 0; i < maps.size(); ++i) placed.push_back({&maps[i], poses[i]});
  return placed;
}

/// Whether the two are one in all.
bool are_the_same(const FusedMap& a, const FusedMap& b) {
  const auto omega_of = [](const FusedMap& fused) {
    return fused.omega ? std::pair(fused.omega->equal, fused.omega->cells)
                       : std::pair<std::int64_t, std::int64_t>(-1, -1);
  };
  return are_equal(a.grid, b.grid) && a.agreeing == b.agreeing && a.conflicting == b.conflicting &&
         omega_of(a) == omega_of(b);
}

bool is_what_fuse_makes(const std::vector<PlacedMap>& was, const std::vector<PlacedMap>& now,
                        double resolution) {
  return are_the_same(fuse_changes(fuse(was, resolution), was, now, resolution), fuse(now, resolution));
}

RC_GTEST_PROP(FuseChanges, IsWhatFuseMakesOfTheNewMaps, ()) {
  std::vector<OccupancyGrid> before;
  std::vector<SE2> poses;
  for (int i = *rc::gen::inRange(1, 4); i > 0; --i) {
    before.push_back(some_map());
    const bool in_line = *rc::gen::arbitrary<bool>();
    poses.push_back(in_line ? SE2{some(-2, 2), some(-2, 2), *rc::gen::inRange(-1, 3) * std::numbers::pi / 2}
                            : SE2{some(-2, 2), some(-2, 2), some(-3, 3)});
  }
  std::vector<OccupancyGrid> after = before;
  for (OccupancyGrid& map : after) {
    for (int i = *rc::gen::inRange(0, 4); i > 0; --i) {
      const std::size_t at = *rc::gen::inRange<std::size_t>(0, map.cells.size());
      map.cells[at] = *rc::gen::element(Cell::unknown, Cell::free, Cell::occupied);
      if (!map.probability.empty() && map.cells[at] == Cell::occupied) map.probability[at] = 0.875f;
    }
  }
  const double resolution = *rc::gen::elementOf(std::vector<double>{0.05, 0.1, 0.17, 0.5});
  RC_ASSERT(is_what_fuse_makes(placed(before, poses), placed(after, poses), resolution));
}

TEST(FuseChanges, WhereMoreThanCellsHasChangedAllIsFused) {
  const OccupancyGrid a = test::map_from({"####", "#..#", "#..#", "####"});
  const OccupancyGrid b = test::map_from({"#.#", "..."});
  OccupancyGrid grown = make_grid(6, 4, 1.0, {}, Cell::free);
  OccupancyGrid moved = a;
  moved.origin.x = 0.5;
  const std::vector<PlacedMap> was{{&a, {}}, {&b, {1.0, 1.0, 0.0}}};
  EXPECT_TRUE(is_what_fuse_makes(was, {{&grown, {}}, {&b, {1.0, 1.0, 0.0}}}, 1.0));
  EXPECT_TRUE(is_what_fuse_makes(was, {{&moved, {}}, {&b, {1.0, 1.0, 0.0}}}, 1.0));
  EXPECT_TRUE(is_what_fuse_makes(was, {{&a, {}}, {&b, {1.0, 1.0, 0.1}}}, 1.0));
  EXPECT_TRUE(is_what_fuse_makes(was, {{&a, {}}}, 1.0));
  EXPECT_TRUE(is_what_fuse_makes({{&a, {}}}, was, 1.0));
}

TEST(FuseChanges, PaintIsSeenThroughAsBefore) {
  OccupancyGrid sheet = make_grid(60, 60, 0.1, {}, Cell::occupied);
  for (int row = 2; row < 20; ++row)
    for (int column = 2; column < 20; ++column) sheet.at(column, row) = Cell::free;
  OccupancyGrid later = sheet;
  for (int row = 2; row < 20; ++row) later.at(20, row) = Cell::free;  // the wall is seen further out
  EXPECT_TRUE(is_what_fuse_makes({{&sheet, {}}}, {{&later, {}}}, 0.1));
}

/// Twice all cells is more than all.
TEST(FuseChanges, ThatLieFarApartAreFusedWithAllElse) {
  OccupancyGrid map = make_grid(50, 50, 0.1, {}, Cell::free);
  OccupancyGrid later = map;
  later.at(0, 0) = later.at(49, 49) = Cell::occupied;
  FusedMap before = fuse({{&map, {}}}, 0.1);
  before.grid.at(25, 25) = Cell::occupied;
  EXPECT_EQ(fuse_changes(before, {{&map, {}}}, {{&later, {}}}, 0.1).grid.at(25, 25), Cell::free);
}

/// Cells that cannot have changed are those that were given.
TEST(FuseChanges, DrawsOnlyWhatHasChanged) {
  OccupancyGrid map = make_grid(50, 50, 0.1, {}, Cell::free);
  OccupancyGrid later = map;
  later.at(40, 40) = Cell::occupied;
  FusedMap before = fuse({{&map, {}}}, 0.1);
  before.grid.at(5, 5) = Cell::occupied;
  const FusedMap found = fuse_changes(before, {{&map, {}}}, {{&later, {}}}, 0.1);
  EXPECT_EQ(found.grid.at(5, 5), Cell::occupied);
  EXPECT_EQ(found.grid.at(40, 40), Cell::occupied);
  EXPECT_EQ(count_cells(found.grid).occupied, 2u);
}

}  // namespace
}  // namespace gridmerge::internal
