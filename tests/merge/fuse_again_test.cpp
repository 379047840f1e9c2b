// SPDX-License-Identifier: Apache-2.0
#include "merge/fuse_again.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cstring>
#include <numbers>

#include "grid/equal_grids.hpp"
#include "gridmerge/grid/resample.hpp"
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

/// What fuse() makes of the maps as they are now.
void expect_the_same(const std::vector<PlacedMap>& was, const std::vector<PlacedMap>& now,
                     double resolution) {
  const FusedMap expected = fuse(now, resolution);
  const FusedMap found = fuse_again(fuse(was, resolution), was, now, resolution);
  RC_ASSERT(are_equal(found.grid, expected.grid));
  RC_ASSERT(found.agreeing == expected.agreeing);
  RC_ASSERT(found.conflicting == expected.conflicting);
  RC_ASSERT(found.omega.has_value() == expected.omega.has_value());
  if (found.omega) {
    RC_ASSERT(found.omega->equal == expected.omega->equal);
    RC_ASSERT(found.omega->cells == expected.omega->cells);
  }
}

RC_GTEST_PROP(FuseAgain, IsWhatFuseMakesOfTheNewMaps, ()) {
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
  expect_the_same(placed(before, poses), placed(after, poses), resolution);
}

TEST(FuseAgain, WhereMoreThanCellsHasChangedAllIsFused) {
  const OccupancyGrid a = test::map_from({"####", "#..#", "#..#", "####"});
  const OccupancyGrid b = test::map_from({"#.#", "..."});
  OccupancyGrid grown = make_grid(6, 4, 1.0, {}, Cell::free);
  OccupancyGrid moved = a;
  moved.origin.x = 0.5;
  const std::vector<PlacedMap> was{{&a, {}}, {&b, {1.0, 1.0, 0.0}}};
  expect_the_same(was, {{&grown, {}}, {&b, {1.0, 1.0, 0.0}}}, 1.0);
  expect_the_same(was, {{&moved, {}}, {&b, {1.0, 1.0, 0.0}}}, 1.0);
  expect_the_same(was, {{&a, {}}, {&b, {1.0, 1.0, 0.1}}}, 1.0);
  expect_the_same(was, {{&a, {}}}, 1.0);
  expect_the_same({{&a, {}}}, was, 1.0);
}

TEST(FuseAgain, PaintIsSeenThroughAsBefore) {
  OccupancyGrid sheet = make_grid(60, 60, 0.1, {}, Cell::occupied);
  for (int row = 2; row < 20; ++row)
    for (int column = 2; column < 20; ++column) sheet.at(column, row) = Cell::free;
  OccupancyGrid later = sheet;
  for (int row = 2; row < 20; ++row) later.at(20, row) = Cell::free;  // the wall is seen further out
  expect_the_same({{&sheet, {}}}, {{&later, {}}}, 0.1);
}

/// Cells that cannot have changed are those that were given.
TEST(FuseAgain, DrawsOnlyWhatHasChanged) {
  OccupancyGrid map = make_grid(50, 50, 0.1, {}, Cell::free);
  OccupancyGrid later = map;
  later.at(40, 40) = Cell::occupied;
  FusedMap before = fuse({{&map, {}}}, 0.1);
  before.grid.at(5, 5) = Cell::occupied;
  const FusedMap found = fuse_again(before, {{&map, {}}}, {{&later, {}}}, 0.1);
  EXPECT_EQ(found.grid.at(5, 5), Cell::occupied);
  EXPECT_EQ(found.grid.at(40, 40), Cell::occupied);
  EXPECT_EQ(count_cells(found.grid).occupied, 2u);
}

}  // namespace
}  // namespace gridmerge::internal
