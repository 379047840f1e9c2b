// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <set>
#include <vector>

#include "gridmerge/similarity/image_similarity.hpp"
#include "literal_similarity.hpp"
#include "random_grid.hpp"

namespace gridmerge {
namespace {

SE2 random_pose(std::mt19937& random, double reach) {
  std::uniform_real_distribution<double> shift(-reach, reach), turn(-3.1, 3.1);
  return {shift(random), shift(random), turn(random)};
}

TEST(DrawOnLattice, EqualsTheLiteralTransformOfAMap) {
  std::mt19937 random(3);
  for (unsigned run = 0; run < 60; ++run) {
    const OccupancyGrid lattice = test::random_grid(run, 37, 29, 0.1, random_pose(random, 3.0));
    const OccupancyGrid map =
        test::random_grid(run + 100, 31, 43, run % 2 == 0 ? 0.1 : 0.07, random_pose(random, 3.0));
    const SE2 T = random_pose(random, 3.0);
    const OccupancyGrid drawn = draw_on_lattice(lattice, {&map, T});
    const OccupancyGrid expected = literal::draw_on(lattice, map, T);
    EXPECT_EQ(drawn.cells, expected.cells) << run;
    EXPECT_EQ(drawn.resolution, lattice.resolution);
    EXPECT_EQ(drawn.origin, lattice.origin);
  }
}

TEST(DrawOnLattice, AMapOnItsOwnLatticeIsItself) {
  const OccupancyGrid map = test::random_grid(5, 30, 20, 0.05, {-3.0, 1.0, 0.7});
  EXPECT_EQ(draw_on_lattice(map, {&map, {}}).cells, map.cells);
}

TEST(DrawOnLattice, WhatLiesBesideTheLatticeLeavesItUnknown) {
  const OccupancyGrid map = test::random_grid(5, 30, 20);
  const OccupancyGrid drawn = draw_on_lattice(map, {&map, {500.0, 0.0, 0.0}});
  EXPECT_EQ(count_cells(drawn).known(), 0U);
}

TEST(EqualCells, OfKMapsAtPosesAreCountedCellByCell) {
  std::mt19937 random(4);
  for (unsigned run = 0; run < 30; ++run) {
    const OccupancyGrid lattice = make_grid(25, 35, 0.1, random_pose(random, 1.0));
    std::vector<OccupancyGrid> grids;
    std::vector<PlacedMap> maps;
    for (unsigned i = 0; i < 4; ++i) grids.push_back(test::random_grid(run * 4 + i, 30, 30));
    for (const OccupancyGrid& grid : grids) maps.push_back({&grid, random_pose(random, 2.0)});
    std::int64_t expected = 0;
    for (std::size_t i = 0; i < lattice.cells.size(); ++i) {
      std::set<Cell> values;
      for (const PlacedMap& map : maps)
        values.insert(literal::draw_on(lattice, *map.map, map.T_output_map).cells[i]);
      expected += values.size() == 1 ? 1 : 0;
    }
    EXPECT_EQ(count_equal_cells(lattice, maps), expected) << run;
    std::shuffle(maps.begin(), maps.end(), random);
    EXPECT_EQ(count_equal_cells(lattice, maps), expected) << run;
    EXPECT_EQ(count_equal_cells(lattice, std::span(maps).first(1)), 25 * 35);
    EXPECT_EQ(count_equal_cells(lattice, {}), 0);
  }
}

TEST(EqualCells, TheMeterCountsTheSameOfTwoMaps) {
  std::mt19937 random(6);
  for (unsigned run = 0; run < 100; ++run) {
    // Known in a part only, so that the known rectangle is another one than the map's.
    OccupancyGrid fixed = make_grid(50, 40, 0.1, random_pose(random, 3.0));
    const OccupancyGrid part = test::random_grid(run, 20, 15);
    for (int row = 0; row < part.height; ++row) {
      for (int column = 0; column < part.width; ++column)
        fixed.at(column + 3 + static_cast<int>(run % 25), row + static_cast<int>(run % 20)) =
            part.at(column, row);
    }
    const OccupancyGrid moving =
        test::random_grid(run + 500, 40, 50, run % 3 == 0 ? 0.13 : 0.1, random_pose(random, 2.0));
    const SE2 T = random_pose(random, 4.0);
    SimilarityMeter meter(fixed, moving);
    const ImageSimilarity found = meter(T);
    EXPECT_EQ(found.omega, count_equal_cells(fixed, moving, T)) << run;
    const CommonClasses common = meter.count_common(T);
    EXPECT_EQ(common.occupied_occupied + common.free_free, found.agreement);
    EXPECT_EQ(common.contradicting, found.disagreement);
    const OccupancyGrid drawn = literal::draw_on(fixed, moving, T);
    std::int64_t walls = 0;
    for (std::size_t i = 0; i < drawn.cells.size(); ++i)
      walls += drawn.cells[i] == Cell::occupied && fixed.cells[i] == Cell::occupied ? 1 : 0;
    EXPECT_EQ(common.occupied_occupied, walls);
  }
}

TEST(LieOnEachOther, WhenTheKnownRectanglesShareACell) {
  OccupancyGrid fixed = make_grid(100, 100, 0.1);
  for (int i = 40; i < 60; ++i) fixed.at(i, 50) = Cell::free;  // x 4 to 6 m, y 5 to 5.1 m
  OccupancyGrid moving = make_grid(10, 10, 0.1, {}, Cell::occupied);
  EXPECT_TRUE(lie_on_each_other(fixed, moving, {4.5, 4.5, 0.0}));
  EXPECT_TRUE(lie_on_each_other(fixed, moving, {5.95, 5.0, 0.0}));
  EXPECT_FALSE(lie_on_each_other(fixed, moving, {6.0, 5.0, 0.0}));
  EXPECT_FALSE(lie_on_each_other(fixed, moving, {0.0, 0.0, 0.0})) << "in the map, but where it knows nothing";
  EXPECT_FALSE(lie_on_each_other(fixed, moving, {1e9, 0.0, 0.0}));
  EXPECT_FALSE(lie_on_each_other(fixed, moving, {0.0, std::nan(""), 0.0}));
}

TEST(LieOnEachOther, AtTheVeryEdgeOfWhereMapsMayLie) {
  OccupancyGrid map = make_grid(100, 100, 0.1, {kMaxOrigin, -kMaxOrigin, 0.5});
  for (int i = 40; i < 60; ++i) map.at(i, 50) = Cell::free;
  EXPECT_TRUE(lie_on_each_other(map, map, {}));
}

TEST(Lattice, RefusesWhatItCannotDraw) {
  const OccupancyGrid map = make_grid(6, 4, 0.1, {}, Cell::free);
  const OccupancyGrid fine = make_grid(6, 4, 0.0009, {}, Cell::free);
  OccupancyGrid broken = map;
  broken.cells.pop_back();
  const SE2 nowhere{std::numeric_limits<double>::infinity(), 0.0, 0.0};
  EXPECT_THROW(draw_on_lattice(map, {&map, nowhere}), std::invalid_argument);
  EXPECT_THROW(draw_on_lattice(map, {&map, {1e300, 0.0, 0.0}}), std::invalid_argument);
  EXPECT_THROW(draw_on_lattice(map, {&fine, {}}), std::invalid_argument);
  EXPECT_THROW(draw_on_lattice(broken, {&map, {}}), std::invalid_argument);
  EXPECT_THROW(lie_on_each_other(map, broken, {}), std::invalid_argument);
  EXPECT_THROW(draw_on_lattice(map, PlacedMap{}), std::invalid_argument);
  for (const PlacedMap& bad : {PlacedMap{&broken, {}}, PlacedMap{}}) {
    const std::vector<PlacedMap> maps{{&map, {}}, bad};
    EXPECT_THROW(count_equal_cells(map, maps), std::invalid_argument);
  }
  const std::vector<PlacedMap> maps{{&map, {}}};
  EXPECT_THROW(count_equal_cells(broken, maps), std::invalid_argument);
}

}  // namespace
}  // namespace gridmerge
