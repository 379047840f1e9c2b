// SPDX-License-Identifier: Apache-2.0
#include "simulate/mapper.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>
#include <utility>

#include "simulate/random.hpp"

namespace gridmerge {

using namespace internal;
namespace {

Cell value_at(const OccupancyGrid& grid, Point2 p) {
  const Point2 at = inverse(grid.origin) * p;
  const int column = static_cast<int>(std::floor(at.x / grid.resolution));
  const int row = static_cast<int>(std::floor(at.y / grid.resolution));
  return grid.contains(column, row) ? grid.at(column, row) : Cell::unknown;
}

TEST(Mapper, DrawsBeamsFreeAndTheirEndsOccupied) {
  Random random(3);
  for (int run = 0; run < 200; ++run) {
    Mapper mapper(0.1, {-6.0, -6.0, 6.0, 6.0});
    const Point2 from{random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0)};
    const double angle = run % 10 == 0 ? 1.5707963267948966 * (run / 10 % 4) : random.uniform(0.0, 6.3);
    const double length = random.uniform(0.3, 4.0);
    const Point2 to{from.x + length * std::cos(angle), from.y + length * std::sin(angle)};
    for (int i = 0; i < 4; ++i) mapper.add_beam(from, to, true);
    const OccupancyGrid grid = mapper.grid();
    EXPECT_EQ(value_at(grid, to), Cell::occupied);
    // Every cell that the beam crosses well is free, and they are as many as the beam has borders.
    for (double at = 0.0; at < length - 0.15; at += 0.01) {
      const Point2 p{from.x + at * std::cos(angle), from.y + at * std::sin(angle)};
      const auto inside = [](double x) {
        const double share = x / 0.1 - std::floor(x / 0.1);
        return share > 0.02 && share < 0.98;
      };
      if (inside(p.x) && inside(p.y)) {
        EXPECT_EQ(value_at(grid, p), Cell::free) << run << " " << at;
      }
    }
    const auto cell = [](double x) { return std::floor(x / 0.1); };
    const double crossings = std::abs(cell(to.x) - cell(from.x)) + std::abs(cell(to.y) - cell(from.y));
    EXPECT_EQ(static_cast<double>(count_cells(grid).known()), crossings + 1.0);
  }
}

TEST(Mapper, DrawsTheSameInAWiderRaster) {
  Random random(5);
  for (int run = 0; run < 50; ++run) {
    const double resolution = random.uniform(0.01, 0.2);
    Mapper narrow(resolution, {-3.0, -3.0, 3.0, 3.0});
    Mapper wide(resolution, {-random.uniform(3.0, 9.0), -4.0, 3.0, random.uniform(3.0, 9.0)});
    const Point2 from{random.uniform(-2.0, 2.0), random.uniform(-2.0, 2.0)};
    const Point2 to{random.uniform(-2.9, 2.9), random.uniform(-2.9, 2.9)};
    narrow.add_beam(from, to, true);
    wide.add_beam(from, to, true);
    EXPECT_EQ(narrow.grid().cells, wide.grid().cells);
    EXPECT_EQ(narrow.grid().origin, wide.grid().origin);
  }
}

TEST(Mapper, ARasterOfTooManyCellsIsRefused) {
  EXPECT_THROW(Mapper(0.01, {-200.0, -200.0, 200.0, 200.0}), std::invalid_argument);
  EXPECT_THROW(Mapper(0.01, {0.0, 0.0, 1e12, 1.0}), std::invalid_argument);
  EXPECT_NO_THROW(Mapper(0.01, {-200.0, 0.0, 200.0, 1.0}));  // long, but narrow
}

TEST(Mapper, WhatBeamsPassOftenIsFreeAgainAndOutsideIsLeftOut) {
  Mapper mapper(0.1, {-2.0, -2.0, 2.0, 2.0});
  mapper.add_beam({0.0, 0.0}, {1.05, 0.05}, true);
  EXPECT_EQ(value_at(mapper.grid(), {1.05, 0.05}), Cell::occupied);
  for (int i = 0; i < 6; ++i) mapper.add_beam({0.05, 0.05}, {50.0, 0.05}, true);
  const OccupancyGrid grid = mapper.grid();
  EXPECT_EQ(value_at(grid, {1.05, 0.05}), Cell::free);
  for (std::size_t i = 0; i < grid.cells.size(); ++i) {
    const float least = grid.cells[i] == Cell::occupied ? 0.65F : 0.0F;
    const float most = grid.cells[i] == Cell::free ? 0.196F : 1.0F;
    if (grid.cells[i] == Cell::unknown) continue;
    EXPECT_GT(grid.probability[i], least);
    EXPECT_LT(grid.probability[i], most);
  }
}

TEST(Mapper, BelievesBeamsByTheirLogOdds) {
  // At the beam's end after so many of them, and in the cell before it, which one alone leaves unknown.
  const auto probabilities = [](int beams) {
    Mapper mapper(0.1, {-2.0, -2.0, 2.0, 2.0});
    for (int i = 0; i < beams; ++i) mapper.add_beam({0.05, 0.05}, {1.05, 0.05}, true);
    const OccupancyGrid grid = mapper.grid();
    return std::pair(grid.probability.back(),
                     grid.probability[grid.probability.size() > 1 ? grid.probability.size() - 2 : 0]);
  };
  const auto logistic = [](double x) { return static_cast<float>(1.0 / (1.0 + std::exp(-x))); };
  EXPECT_NEAR(probabilities(1).first, logistic(0.85), 1e-6);
  EXPECT_NEAR(probabilities(3).first, logistic(2.55), 1e-6);
  EXPECT_NEAR(probabilities(3).second, logistic(-1.5), 1e-6);
  EXPECT_NEAR(probabilities(50).first, logistic(4.0), 1e-6);
  EXPECT_NEAR(probabilities(50).second, logistic(-4.0), 1e-6);
}

}  // namespace
}  // namespace gridmerge
