// SPDX-License-Identifier: Apache-2.0
#include "gridmerge/grid/occupancy_grid.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <numbers>
#include <ostream>
#include <stdexcept>
#include <string>

namespace gridmerge {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

TEST(OccupancyGrid, IsMadeFilled) {
  const OccupancyGrid grid = make_grid(3, 2, 0.5, {1.0, 2.0, 0.1}, Cell::free);
  EXPECT_EQ(grid.width, 3);
  EXPECT_EQ(grid.height, 2);
  EXPECT_EQ(grid.resolution, 0.5);
  EXPECT_EQ(grid.origin, (SE2{1.0, 2.0, 0.1}));
  EXPECT_EQ(grid.cells, std::vector<Cell>(6, Cell::free));
  EXPECT_TRUE(grid.probability.empty());
}

TEST(OccupancyGrid, IsNoneOfNegativeSize) {
  EXPECT_THROW(make_grid(-1, 5, 0.1), std::invalid_argument);
  EXPECT_THROW(make_grid(5, -1, 0.1), std::invalid_argument);
  EXPECT_THROW(make_grid(-2, -2, 0.1), std::invalid_argument);
}

TEST(OccupancyGrid, IsRowMajor) {
  OccupancyGrid grid = make_grid(3, 2, 1.0);
  grid.at(2, 1) = Cell::occupied;
  EXPECT_EQ(grid.cells[5], Cell::occupied);
  EXPECT_EQ(grid.index(1, 1), 4u);
}

TEST(OccupancyGrid, ContainsItsCellsOnly) {
  const OccupancyGrid grid = make_grid(3, 2, 1.0);
  EXPECT_TRUE(grid.contains(0, 0));
  EXPECT_TRUE(grid.contains(2, 1));
  EXPECT_FALSE(grid.contains(3, 1));
  EXPECT_FALSE(grid.contains(2, 2));
  EXPECT_FALSE(grid.contains(-1, 0));
  EXPECT_FALSE(grid.contains(0, -1));
}

TEST(OccupancyGrid, CellCentresFollowTheOrigin) {
  const OccupancyGrid grid = make_grid(4, 4, 2.0, {10.0, 20.0, std::numbers::pi / 2});
  const Point2 centre =
      grid.cell_centre(2, 0);  // 5 m along the grid's x axis, which points along the map's y
  EXPECT_NEAR(centre.x, 9.0, 1e-12);
  EXPECT_NEAR(centre.y, 25.0, 1e-12);
}

TEST(OccupancyGrid, CountsCells) {
  OccupancyGrid grid = make_grid(4, 2, 1.0);
  grid.at(0, 0) = Cell::occupied;
  grid.at(1, 0) = grid.at(2, 0) = Cell::free;
  const CellCounts counts = count_cells(grid);
  EXPECT_EQ(counts.occupied, 1u);
  EXPECT_EQ(counts.free, 2u);
  EXPECT_EQ(counts.unknown, 5u);
  EXPECT_EQ(counts.known(), 3u);
}

TEST(Validate, AcceptsAGoodGrid) {
  OccupancyGrid grid = make_grid(2, 3, 0.05, {-1.0, 2.0, 3.0});
  EXPECT_NO_THROW(validate(grid));
  grid.probability.assign(6, 0.5f);
  EXPECT_NO_THROW(validate(grid));
}

TEST(Validate, AcceptsWhatFilesMayHoldAndALittleBeyond) {
  for (const double resolution : {kMinResolution, kMaxResolution})
    EXPECT_NO_THROW(validate(make_grid(2, 3, resolution))) << resolution;
  for (const double x : {-kMaxOrigin, kMaxOrigin, kMaxOrigin + 100.0})
    EXPECT_NO_THROW(validate(make_grid(2, 3, 0.05, {x, x, 0.0}))) << x;
}

TEST(Validate, APlacedMapHasAValidMapAndAFinitePose) {
  const OccupancyGrid grid = make_grid(2, 3, 0.05);
  const OccupancyGrid none;
  EXPECT_NO_THROW(validate(PlacedMap{&grid, {1.0, 2.0, 3.0}}));
  EXPECT_THROW(validate(PlacedMap{}), std::invalid_argument);
  EXPECT_THROW(validate(PlacedMap{&none, {}}), std::invalid_argument);
  EXPECT_THROW(validate(PlacedMap{&grid, {kNan, 0.0, 0.0}}), std::invalid_argument);
}

struct Flaw {
  const char* name;
  std::function<void(OccupancyGrid&)> spoil;
  const char* message;  // a part of it

  friend void PrintTo(const Flaw& bad, std::ostream* out) { *out << bad.name; }
};

class ValidateRefuses : public testing::TestWithParam<Flaw> {};

TEST_P(ValidateRefuses, AndSaysWhy) {
  OccupancyGrid grid = make_grid(2, 3, 0.05);
  GetParam().spoil(grid);
  try {
    validate(grid);
    FAIL() << "accepted";
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find(GetParam().message), std::string::npos) << error.what();
  }
}

INSTANTIATE_TEST_SUITE_P(
    Flaws, ValidateRefuses,
    testing::Values(
        Flaw{"ZeroWidth", [](auto& g) { g.width = 0; }, "width and height"},
        Flaw{"NegativeHeight", [](auto& g) { g.height = -3; }, "width and height"},
        Flaw{"BothNegative", [](auto& g) { g.width = -2, g.height = -3; }, "width and height"},
        Flaw{"TooFewCells", [](auto& g) { g.cells.pop_back(); }, "cells"},
        Flaw{"TooManyCells", [](auto& g) { g.cells.push_back(Cell::free); }, "cells"},
        Flaw{"TooFewProbabilities", [](auto& g) { g.probability.assign(5, 0.5f); }, "probabilities"},
        Flaw{"ZeroResolution", [](auto& g) { g.resolution = 0.0; }, "resolution"},
        Flaw{"NegativeResolution", [](auto& g) { g.resolution = -0.05; }, "resolution"},
        Flaw{"NanResolution", [](auto& g) { g.resolution = kNan; }, "resolution"},
        Flaw{"InfiniteResolution", [](auto& g) { g.resolution = kInfinity; }, "resolution"},
        Flaw{"TinyResolution", [](auto& g) { g.resolution = 9e-7; }, "resolution"},
        Flaw{"HugeResolution", [](auto& g) { g.resolution = 1001.0; }, "resolution"},
        Flaw{"FarOrigin", [](auto& g) { g.origin.y = -2.1 * kMaxOrigin; }, "origin"},
        Flaw{"NoCell", [](auto& g) { g.cells[3] = static_cast<Cell>(3); }, "unknown, free"},
        Flaw{"LastCell", [](auto& g) { g.cells.back() = static_cast<Cell>(255); }, "unknown, free"},
        Flaw{"NanX", [](auto& g) { g.origin.x = kNan; }, "origin"},
        Flaw{"InfiniteY", [](auto& g) { g.origin.y = -kInfinity; }, "origin"},
        Flaw{"NanYaw", [](auto& g) { g.origin.theta = kNan; }, "origin"}),
    [](const auto& instance) { return std::string(instance.param.name); });

}  // namespace
}  // namespace gridmerge
