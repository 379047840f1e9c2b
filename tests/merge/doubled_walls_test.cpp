// SPDX-License-Identifier: Apache-2.0
#include "merge/doubled_walls.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace gridmerge::internal {
namespace {

/// A corridor of 30 m x 4 m along x, open at its ends: walls that face up and down.
OccupancyGrid corridor(const SE2& origin) {
  OccupancyGrid map = make_grid(600, 90, 0.05, origin, Cell::free);
  for (int column = 0; column < map.width; ++column) {
    for (const int row : {4, 5, 84, 85}) map.at(column, row) = Cell::occupied;
    for (const int row : {0, 1, 2, 3, 86, 87, 88, 89}) map.at(column, row) = Cell::unknown;
  }
  return map;
}

/// Maps of one corridor, of which each but the first lies off its place.
DoubledWalls measured(const std::vector<SE2>& offs) {
  std::vector<OccupancyGrid> maps;
  Component component;
  for (std::size_t i = 0; i < offs.size(); ++i) {
    const SE2 T_component_map{1.0 + static_cast<double>(i), -2.0, 0.4 * static_cast<double>(i)};
    maps.push_back(corridor(inverse(T_component_map)));
    Member member;
    member.map = i;
    member.T_component_map = offs[i] * T_component_map;
    component.members.push_back(member);
  }
  return measure_doubled_walls(maps, component);
}

TEST(DoubledWalls, AreThoseThatLieMoreThanTwoDecimetresApart) {
  const DoubledWalls exact = measured({{}, {}});
  EXPECT_GT(exact.compared, 500.0);  // 300 of each
  EXPECT_LE(exact.compared, 600.0);
  EXPECT_EQ(exact.doubled, 0.0);
  EXPECT_EQ(exact.share(), 0.0);
  // Across the walls, either way.
  EXPECT_EQ(measured({{}, {0.0, 0.15, 0.0}}).share(), 0.0);
  EXPECT_EQ(measured({{}, {0.0, 0.3, 0.0}}).share(), 1.0);
  EXPECT_EQ(measured({{}, {0.0, -0.3, 0.0}}).share(), 1.0);
  // Along them nothing shows.
  EXPECT_EQ(measured({{}, {0.7, 0.0, 0.0}}).share(), 0.0);
  // Beyond a metre they are other walls: those that face the same side are 4 m away.
  EXPECT_EQ(measured({{}, {0.0, 1.5, 0.0}}).compared, 0.0);
  EXPECT_EQ(measured({{}, {0.0, 1.5, 0.0}}).share(), 0.0);
}

TEST(DoubledWalls, AreCountedForEachTwoMaps) {
  const DoubledWalls two = measured({{}, {0.0, 0.3, 0.0}});
  const DoubledWalls three = measured({{}, {0.0, 0.3, 0.0}, {}});
  EXPECT_NEAR(three.compared, 3.0 * two.compared, 0.05 * three.compared);
  EXPECT_NEAR(three.share(), 2.0 / 3.0, 0.02);
  EXPECT_EQ(measured({{}}).compared, 0.0);
  EXPECT_EQ(measured({}).compared, 0.0);
}

TEST(DoubledWalls, FollowTheBendOfTheirMaps) {
  std::vector<OccupancyGrid> maps{corridor({}), corridor({})};
  Component component;
  component.members.resize(2);
  component.members[1].map = 1;
  // Shifted as a whole by 0.4 m across the walls, which its pose takes back.
  component.members[1].deformation =
      Deformation({-1.0, -1.0, 0.0}, 20.0, 5, 4, std::vector<Point2>(20, {0.0, 0.4}));
  EXPECT_EQ(measure_doubled_walls(maps, component).share(), 1.0);
  component.members[1].T_component_map = {0.0, -0.4, 0.0};
  EXPECT_EQ(measure_doubled_walls(maps, component).share(), 0.0);
}

}  // namespace
}  // namespace gridmerge::internal
