// SPDX-License-Identifier: Apache-2.0
#include "gridmerge/grid/resample.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "grid/generators.hpp"
#include "grid/painted.hpp"
#include "grid/quarter_turned.hpp"

namespace gridmerge {
namespace {

// The cell of the grid under a point of the map frame; unknown outside. Points near a cell's border are no
// use here.
Cell cell_under(const OccupancyGrid& grid, const Point2& p_map) {
  const Point2 p = inverse(grid.origin) * p_map;
  const int column = static_cast<int>(std::floor(p.x / grid.resolution));
  const int row = static_cast<int>(std::floor(p.y / grid.resolution));
  return grid.contains(column, row) ? grid.at(column, row) : Cell::unknown;
}

// Whether every cell of `a`, moved by T_b_a, is found in `b`.
bool shows_the_cells_of(const OccupancyGrid& b, const OccupancyGrid& a, const SE2& T_b_a) {
  for (int row = 0; row < a.height; ++row) {
    for (int column = 0; column < a.width; ++column) {
      if (cell_under(b, T_b_a * a.cell_centre(column, row)) != a.at(column, row)) return false;
    }
  }
  return true;
}

bool row_is_unknown(const OccupancyGrid& grid, int row) {
  for (int column = 0; column < grid.width; ++column) {
    if (grid.at(column, row) != Cell::unknown) return false;
  }
  return true;
}

bool column_is_unknown(const OccupancyGrid& grid, int column) {
  for (int row = 0; row < grid.height; ++row) {
    if (grid.at(column, row) != Cell::unknown) return false;
  }
  return true;
}

RC_GTEST_PROP(CropToKnown, KeepsCellsAtTheirCoordinates, (const OccupancyGrid& grid)) {
  const OccupancyGrid cropped = crop_to_known(grid);
  validate(cropped);
  RC_ASSERT(cropped.resolution == grid.resolution);
  RC_ASSERT(shows_the_cells_of(cropped, grid, {}));
}

RC_GTEST_PROP(CropToKnown, IsTheSmallest, (const OccupancyGrid& grid)) {
  const OccupancyGrid cropped = crop_to_known(grid);
  if (count_cells(grid).known() == 0) {
    RC_ASSERT(cropped.cells == std::vector<Cell>{Cell::unknown});
    return;
  }
  RC_ASSERT(!row_is_unknown(cropped, 0));
  RC_ASSERT(!row_is_unknown(cropped, cropped.height - 1));
  RC_ASSERT(!column_is_unknown(cropped, 0));
  RC_ASSERT(!column_is_unknown(cropped, cropped.width - 1));
}

TEST(CropToKnown, TakesTheProbabilitiesAlong) {
  OccupancyGrid grid = make_grid(4, 3, 1.0);
  grid.probability.resize(12);
  for (std::size_t i = 0; i < 12; ++i) grid.probability[i] = static_cast<float>(i);
  grid.at(1, 1) = grid.at(2, 2) = Cell::free;
  EXPECT_EQ(crop_to_known(grid).probability, (std::vector<float>{5, 6, 9, 10}));
}

TEST(CropToKnown, MovesAYawedOriginAlongItsAxes) {
  OccupancyGrid grid = make_grid(4, 3, 0.5, {10.0, 20.0, std::numbers::pi / 2});
  grid.at(2, 1) = Cell::occupied;
  const OccupancyGrid cropped = crop_to_known(grid);
  EXPECT_NEAR(cropped.origin.x, 10.0 - 0.5, 1e-12);
  EXPECT_NEAR(cropped.origin.y, 20.0 + 1.0, 1e-12);
  EXPECT_EQ(cropped.origin.theta, grid.origin.theta);
}

RC_GTEST_PROP(Downsample, TakesTheStrongestCell, (const OccupancyGrid& grid)) {
  const int factor = *rc::gen::inRange(1, 6);
  const OccupancyGrid coarse = downsample(grid, factor);
  validate(coarse);
  RC_ASSERT(coarse.width == (grid.width + factor - 1) / factor);
  RC_ASSERT(coarse.height == (grid.height + factor - 1) / factor);
  RC_ASSERT(coarse.resolution == grid.resolution * factor);
  RC_ASSERT(coarse.origin == grid.origin);
  for (int row = 0; row < coarse.height; ++row) {
    for (int column = 0; column < coarse.width; ++column) {
      bool any_free = false, any_occupied = false;
      for (int i = 0; i < factor * factor; ++i) {
        const int x = column * factor + i % factor, y = row * factor + i / factor;
        any_free |= grid.contains(x, y) && grid.at(x, y) == Cell::free;
        any_occupied |= grid.contains(x, y) && grid.at(x, y) == Cell::occupied;
      }
      RC_ASSERT(coarse.at(column, row) == (any_occupied ? Cell::occupied
                                           : any_free   ? Cell::free
                                                        : Cell::unknown));
    }
  }
}

TEST(Downsample, TakesAnyPositiveFactor) {
  const OccupancyGrid grid = make_grid(3, 2, 1.0, {}, Cell::free);
  EXPECT_EQ(downsample(grid, 1).cells, grid.cells);
  EXPECT_EQ(downsample(grid, std::numeric_limits<int>::max()).cells, std::vector<Cell>{Cell::free});
  EXPECT_THROW(downsample(grid, 0), std::invalid_argument);
  EXPECT_THROW(downsample(grid, -2), std::invalid_argument);
}

RC_GTEST_PROP(TransformGrid, ByTheIdentityChangesNothing, (OccupancyGrid grid)) {
  grid.origin.theta = 0.0;
  const OccupancyGrid same = transform_grid(grid, {}, grid.resolution);
  RC_ASSERT(same.width == grid.width);
  RC_ASSERT(same.height == grid.height);
  RC_ASSERT(same.origin == grid.origin);
  RC_ASSERT(same.cells == grid.cells);
}

RC_GTEST_PROP(TransformGrid, ByQuarterTurnsIsExact, (OccupancyGrid grid, const SE2& shift)) {
  const int quarters = *rc::gen::inRange(-1, 3);
  grid.origin.theta = normalize_angle(*rc::gen::inRange(-1, 3) * std::numbers::pi / 2);
  const SE2 T{shift.x, shift.y, normalize_angle(quarters * std::numbers::pi / 2)};
  const OccupancyGrid turned = transform_grid(grid, T, grid.resolution);
  validate(turned);
  const bool upright = std::abs(std::cos(T.theta + grid.origin.theta)) > 0.5;
  RC_ASSERT(turned.width == (upright ? grid.width : grid.height));
  RC_ASSERT(turned.height == (upright ? grid.height : grid.width));
  RC_ASSERT(turned.origin.theta == 0.0);
  RC_ASSERT(shows_the_cells_of(turned, grid, T));
}

RC_GTEST_PROP(TransformGrid, TakesTheCellUnderEachCentre, (const OccupancyGrid& grid, const SE2& T)) {
  const OccupancyGrid moved = transform_grid(grid, T, grid.resolution * *between(0.5, 2.0));
  validate(moved);
  for (int row = 0; row < moved.height; ++row) {
    for (int column = 0; column < moved.width; ++column) {
      const Point2 centre = inverse(T) * moved.cell_centre(column, row);
      const Point2 p = inverse(grid.origin) * centre;
      const double x = p.x / grid.resolution, y = p.y / grid.resolution;
      // On a border between cells either is right.
      if (std::abs(x - std::round(x)) < 1e-6 || std::abs(y - std::round(y)) < 1e-6) continue;
      RC_ASSERT(moved.at(column, row) == cell_under(grid, centre));
    }
  }
}

RC_GTEST_PROP(TransformGrid, HoldsTheWholeMap, (const OccupancyGrid& grid, const SE2& T)) {
  const double resolution = grid.resolution * *between(0.5, 2.0);
  const OccupancyGrid moved = transform_grid(grid, T, resolution);
  for (const int column : {0, grid.width - 1}) {
    for (const int row : {0, grid.height - 1}) {
      const Point2 p = T * grid.cell_centre(column, row);
      RC_ASSERT(p.x > moved.origin.x && p.x < moved.origin.x + moved.width * resolution);
      RC_ASSERT(p.y > moved.origin.y && p.y < moved.origin.y + moved.height * resolution);
    }
  }
}

TEST(TransformGrid, RefusesWhatNoGridCanBe) {
  const OccupancyGrid grid = make_grid(100, 100, 1.0);
  EXPECT_THROW(transform_grid(grid, {}, 0.0), std::invalid_argument);
  EXPECT_THROW(transform_grid(grid, {}, -1.0), std::invalid_argument);
  EXPECT_THROW(transform_grid(grid, {}, 1.01 * kMaxResolution), std::invalid_argument);
  EXPECT_THROW(transform_grid(grid, {}, std::numeric_limits<double>::quiet_NaN()), std::invalid_argument);
  EXPECT_THROW(transform_grid(grid, {}, std::numeric_limits<double>::infinity()), std::invalid_argument);
  EXPECT_THROW(transform_grid(grid, {}, 1e-3), std::invalid_argument);  // 10^10 cells
  EXPECT_THROW(transform_grid(grid, {0.0, 0.0, std::nan("")}, 1.0), std::invalid_argument);
  EXPECT_THROW(transform_grid(grid, {HUGE_VAL, 0.0, 0.0}, 1.0), std::invalid_argument);
}

TEST(Resample, RefusesGridsThatAreNone) {
  OccupancyGrid broken = make_grid(3, 2, 0.5);
  broken.cells.pop_back();
  EXPECT_THROW(transform_grid(broken, {}, 1.0), std::invalid_argument);
  EXPECT_THROW(crop_to_known(broken), std::invalid_argument);
  EXPECT_THROW(downsample(broken, 2), std::invalid_argument);
}

TEST(TransformGrid, FindsNothingUnderAFarCentre) {
  const OccupancyGrid grid = make_grid(2, 2, kMinResolution, {}, Cell::occupied);
  EXPECT_EQ(transform_grid(grid, {}, kMaxResolution).cells, std::vector<Cell>{Cell::unknown});
}

RC_GTEST_PROP(QuarterTurned, KeepsEveryCellWhereItIsInTheMapFrame, ()) {
  OccupancyGrid grid = *any_grid();
  const int quarters = *rc::gen::inRange(-5, 6);
  const OccupancyGrid turned = internal::quarter_turned(grid, quarters);
  RC_ASSERT(turned.cells.size() == grid.cells.size());
  const SE2 T_grid_map = inverse(grid.origin);
  for (int row = 0; row < turned.height; ++row) {
    for (int column = 0; column < turned.width; ++column) {
      const Point2 at = T_grid_map * turned.cell_centre(column, row);
      const int x = static_cast<int>(std::floor(at.x / grid.resolution));
      const int y = static_cast<int>(std::floor(at.y / grid.resolution));
      RC_ASSERT(grid.contains(x, y));
      RC_ASSERT(grid.at(x, y) == turned.at(column, row));
    }
  }
}

TEST(QuarterTurned, FourQuartersAreNone) {
  OccupancyGrid grid = make_grid(3, 2, 0.5, {1.0, -2.0, 0.3});
  grid.at(2, 0) = Cell::occupied;
  grid.at(0, 1) = Cell::free;
  EXPECT_EQ(internal::quarter_turned(grid, 4).cells, grid.cells);
  const OccupancyGrid back = internal::quarter_turned(internal::quarter_turned(grid, 1), 3);
  EXPECT_EQ(back.cells, grid.cells);
  EXPECT_EQ(back.width, 3);
  EXPECT_NEAR(back.origin.x, 1.0, 1e-12);
  EXPECT_NEAR(back.origin.theta, 0.3, 1e-12);
}

RC_GTEST_PROP(WithoutPainted, ForgetsWhatNoFreeCellIsNear, (unsigned seed)) {
  OccupancyGrid grid = make_grid(40, 30, 0.1, {}, Cell::occupied);
  grid.probability.assign(grid.cells.size(), 1.0F);
  for (int i = 0; i < 3; ++i) {  // a few free cells and unknown ones
    grid.cells[(seed * 7919U + i * 104729U) % grid.cells.size()] = Cell::free;
    grid.cells[(seed * 15485863U + i * 1299709U) % grid.cells.size()] = Cell::unknown;
  }
  const double reach = *rc::gen::inRange(1, 9) / 10.0;
  const int cells = std::max(3, static_cast<int>(reach / grid.resolution));
  const OccupancyGrid seen = internal::without_painted(grid, reach);
  for (int row = 0; row < grid.height; ++row) {
    for (int column = 0; column < grid.width; ++column) {
      bool is_near = false;
      for (int y = std::max(0, row - cells); y <= std::min(grid.height - 1, row + cells); ++y)
        for (int x = std::max(0, column - cells); x <= std::min(grid.width - 1, column + cells); ++x)
          is_near = is_near || grid.at(x, y) == Cell::free;
      const Cell expected =
          grid.at(column, row) == Cell::occupied && !is_near ? Cell::unknown : grid.at(column, row);
      RC_ASSERT(seen.at(column, row) == expected);
      if (expected != grid.at(column, row)) RC_ASSERT(std::isnan(seen.probability[grid.index(column, row)]));
    }
  }
}

TEST(IsMostlyPainted, AsksForMoreThanHalfOfTheKnownCells) {
  OccupancyGrid grid = make_grid(100, 100, 0.05);
  for (int y = 40; y < 60; ++y)
    for (int x = 40; x < 60; ++x) grid.at(x, y) = Cell::free;
  EXPECT_FALSE(internal::is_mostly_painted(grid));
  const auto paint = [&](int rows) {
    for (int y = 0; y < rows; ++y)
      for (int x = 0; x < 100; ++x) grid.at(x, y) = Cell::occupied;
  };
  paint(4);  // as many cells as are free
  EXPECT_FALSE(internal::is_mostly_painted(grid));
  paint(5);
  EXPECT_TRUE(internal::is_mostly_painted(grid));
  EXPECT_FALSE(internal::is_mostly_painted(make_grid(10, 10, 0.05)));
}

}  // namespace
}  // namespace gridmerge
