// SPDX-License-Identifier: Apache-2.0
#include "report/shown_map.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <random>

#include "merge/drawing.hpp"
#include "report/cells.hpp"

namespace gridmerge {

using namespace internal;
namespace {

using test::map_from;

std::vector<Cell> cells_of(const ShownMap& map) {
  return test::cells_of({{"width", map.width}, {"height", map.height}, {"cells", map.cells}});
}

TEST(ShownMap, HoldsTheCellsFromTheBottomUp) {
  const OccupancyGrid map = map_from({"#.", " ."}, 0.05);
  EXPECT_EQ(cells_of(show_map(map)), (std::vector{Cell::unknown, Cell::free, Cell::occupied, Cell::free}));
}

TEST(ShownMap, IsCroppedToWhatIsKnown) {
  OccupancyGrid map = map_from({"    ", " #. ", "    "}, 0.5);
  map.origin = {1.0, 2.0, 0.0};
  const ShownMap shown = show_map(map);
  EXPECT_EQ(shown.width, 2);
  EXPECT_EQ(shown.height, 1);
  EXPECT_EQ(shown.origin, (SE2{1.5, 2.5, 0.0}));
  EXPECT_EQ(cells_of(shown), (std::vector{Cell::occupied, Cell::free}));
}

TEST(ShownMap, OfNothingKnownOrNothingAtAll) {
  for (const OccupancyGrid& map : {make_grid(5, 4, 0.1), OccupancyGrid{}}) {
    const ShownMap shown = show_map(map);
    EXPECT_EQ(shown.width, 0);
    EXPECT_EQ(shown.height, 0);
    EXPECT_EQ(shown.cells, "");
  }
}

TEST(ShownMap, AnyCellsComeBack) {
  std::mt19937 random(7);
  OccupancyGrid map = make_grid(301, 211, 0.05, {}, Cell::free);
  for (Cell& cell : map.cells) cell = static_cast<Cell>(random() % 3);
  map.cells.front() = map.cells.back() = Cell::occupied;
  EXPECT_EQ(cells_of(show_map(map)), map.cells);
}

TEST(ShownMap, TellsHowMuchCoarserItIs) {
  const OccupancyGrid map = map_from({".#..", "....", "....", "...."}, 0.05);
  EXPECT_FALSE(grid_json(show_map(map, 16)).contains("coarser"));
  EXPECT_EQ(grid_json(show_map(map, 15)).at("coarser"), 2);
  EXPECT_EQ(grid_json(show_map(map, 3)).at("coarser"), 4);
}

TEST(AtMost, LeavesWhatIsSmallEnough) {
  const OccupancyGrid map = map_from({"#.", " ."}, 0.05);
  EXPECT_EQ(at_most(map, 4).cells, map.cells);
}

TEST(AtMost, DoublesTheCellsAsOftenAsItTakes) {
  OccupancyGrid map = map_from({".    ", "  #. ", "  ..#", ".    "}, 0.25);
  map.origin = {1.0, 2.0, 0.5};
  const OccupancyGrid once = at_most(map, 19);
  EXPECT_EQ(once.width, 3);
  EXPECT_EQ(once.height, 2);
  EXPECT_EQ(once.resolution, 0.5);
  EXPECT_EQ(once.origin, map.origin);
  EXPECT_EQ(once.cells, map_from({".# ", "..#"}, 0.5).cells);
  const OccupancyGrid twice = at_most(map, 2);
  EXPECT_EQ(twice.resolution, 1.0);
  EXPECT_EQ(twice.cells, map_from({"##"}, 1.0).cells);
}

TEST(AtMost, ShowsMapsOfTheLargestCellsToo) {
  const OccupancyGrid map = make_grid(9, 9, kMaxResolution, {}, Cell::free);
  const OccupancyGrid shown = at_most(map, 4);
  EXPECT_EQ(shown.cells.size(), 4u);
  EXPECT_EQ(shown.resolution, 8.0 * kMaxResolution);
}

}  // namespace
}  // namespace gridmerge
