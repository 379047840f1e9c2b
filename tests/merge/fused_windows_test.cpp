// SPDX-License-Identifier: Apache-2.0
#include "merge/fused_windows.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <random>
#include <stdexcept>
#include <vector>

#include "gridmerge/merge/fuse.hpp"

namespace gridmerge {

using namespace internal;
namespace {

OccupancyGrid noise(std::mt19937& random, int width, int height, double resolution) {
  OccupancyGrid map = make_grid(width, height, resolution, {0.3, -0.2, 0.4});
  for (Cell& cell : map.cells) cell = static_cast<Cell>(random() % 3);
  return map;
}

bool same_bits(float a, float b) {
  return std::memcmp(&a, &b, sizeof a) == 0 || (std::isnan(a) && std::isnan(b));
}

/// How many cells of a window are not those of the whole map.
int differences(const OccupancyGrid& window, const CellBox& box, const OccupancyGrid& whole) {
  int differ = 0;
  for (int row = box.bottom; row < box.top; ++row) {
    for (int column = box.left; column < box.right; ++column) {
      const std::size_t a = window.index(column - box.left, row - box.bottom), b = whole.index(column, row);
      differ += window.cells[a] != whole.cells[b] || !same_bits(window.probability[a], whole.probability[b]);
    }
  }
  return differ;
}

CellBox any_box(const OccupancyGrid& grid) {
  const int left = *rc::gen::inRange(0, grid.width), bottom = *rc::gen::inRange(0, grid.height);
  return {left, bottom, *rc::gen::inRange(left + 1, grid.width + 1),
          *rc::gen::inRange(bottom + 1, grid.height + 1)};
}

RC_GTEST_PROP(FusedWindows, AreWindowsOfTheFusedMap, ()) {
  std::mt19937 random(*rc::gen::inRange(0U, 1000000U));
  const std::vector<double> resolutions{0.05, 0.1, 0.13};
  std::vector<OccupancyGrid> grids;
  for (int i = 0; i < 3; ++i) grids.push_back(noise(random, 25, 18, resolutions[random() % 3]));
  std::vector<PlacedMap> maps{{&grids[0], {}}};
  for (int i = 1; i < 3; ++i) {
    maps.push_back({&grids[static_cast<std::size_t>(i)],
                    {*rc::gen::inRange(-30, 30) / 10.0, *rc::gen::inRange(-30, 30) / 10.0,
                     *rc::gen::inRange(-31, 31) / 10.0}});
  }
  const double resolution = resolutions[random() % 3];
  const OccupancyGrid whole = fuse(maps, resolution).grid;
  const FusedWindows windows(maps, resolution, {});
  RC_ASSERT(windows.lattice().width == whole.width);
  RC_ASSERT(windows.lattice().height == whole.height);
  const CellBox box = any_box(whole);
  const OccupancyGrid window = windows.fused(box);
  RC_ASSERT(differences(window, box, whole) == 0);
  const Point2 corner = whole.origin * Point2{box.left * resolution, box.bottom * resolution};
  RC_ASSERT(std::hypot(window.origin.x - corner.x, window.origin.y - corner.y) < 1e-9);
}

RC_GTEST_PROP(FusedWindows, AreWindowsOfBentMapsToo, ()) {
  std::mt19937 random(*rc::gen::inRange(0U, 1000000U));
  const OccupancyGrid map = noise(random, 30, 30, 0.1), other = noise(random, 20, 30, 0.1);
  std::vector<Point2> shifts;
  for (int i = 0; i < 49; ++i)
    shifts.push_back(
        {0.0002 * static_cast<double>(random() % 1000), 0.0002 * static_cast<double>(random() % 1000)});
  const std::vector<Deformation> bends{Deformation(), Deformation({-1.0, -1.0, 0.2}, 1.0, 7, 7, shifts)};
  const std::vector<PlacedMap> maps{{&other, {}}, {&map, {1.5, 0.7, 0.6}}};
  const OccupancyGrid whole = fuse(maps, 0.1, bends).grid;
  const FusedWindows windows(maps, 0.1, bends);
  const CellBox box = any_box(whole);
  RC_ASSERT(differences(windows.fused(box), box, whole) == 0);
}

TEST(FusedWindows, AreOfMapsThatFuseDoesNotHold) {
  std::mt19937 random(3);
  const OccupancyGrid map = noise(random, 40, 30, 0.05);
  const std::vector<PlacedMap> maps{{&map, {}}, {&map, {3000.0, 2000.0, 1.0}}};
  EXPECT_THROW(fuse(maps, 0.05), std::invalid_argument);
  const FusedWindows windows(maps, 0.05, {});
  const Lattice& lattice = windows.lattice();
  EXPECT_GT(lattice.width, 60000);
  // Nothing is known between the two, and each is there as when it is fused alone.
  EXPECT_EQ(count_cells(windows.fused({30000, 20000, 30100, 20100})).known(), 0u);
  const OccupancyGrid first = windows.fused({0, 0, 100, 100});
  EXPECT_EQ(count_cells(first).known(), count_cells(fuse({maps[0]}, 0.05).grid).known());
  const OccupancyGrid second =
      windows.fused({lattice.width - 200, lattice.height - 200, lattice.width, lattice.height});
  EXPECT_GT(count_cells(second).occupied, 300u);
}

TEST(FusedWindows, RefuseWhatCannotBe) {
  const OccupancyGrid map = make_grid(3, 2, 0.05, {}, Cell::free);
  EXPECT_THROW(FusedWindows({}, 0.05, {}), std::invalid_argument);
  EXPECT_THROW(FusedWindows({{&map, {}}}, 0.0, {}), std::invalid_argument);
  EXPECT_THROW(FusedWindows({{&map, {}}, {&map, {2e4, 2e4, 0.0}}}, 0.05, {}), std::invalid_argument);
  EXPECT_THROW(FusedWindows({{&map, {}}, {&map, {3e4, 0.0, 0.0}}}, 0.05, {}), std::invalid_argument);
  EXPECT_THROW(FusedWindows({{&map, {}}, {&map, {0.0, 1e9, 0.0}}}, 0.05, {}), std::invalid_argument);
  EXPECT_NO_THROW(FusedWindows({{&map, {}}, {&map, {2e4, 0.0, 0.0}}}, 0.05, {}));
}

}  // namespace
}  // namespace gridmerge
