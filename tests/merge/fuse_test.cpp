// SPDX-License-Identifier: Apache-2.0
#include "gridmerge/merge/fuse.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numbers>
#include <random>
#include <stdexcept>

#include "grid/painted.hpp"
#include "merge/drawing.hpp"

namespace gridmerge {
namespace {

using test::count_wall_pieces;
using test::draw_line;
using test::map_from;
using test::text_of;
using Rows = std::vector<std::string>;

constexpr double kPi = std::numbers::pi;

std::vector<PlacedMap> at_identity(const std::vector<OccupancyGrid>& maps) {
  std::vector<PlacedMap> inputs;
  for (const OccupancyGrid& map : maps) inputs.push_back({&map, {}});
  return inputs;
}

// What `count` maps of one cell each make of that cell.
OccupancyGrid fuse_cells(const std::string& cells) {
  std::vector<OccupancyGrid> maps;
  for (const char cell : cells) maps.push_back(map_from({std::string(1, cell)}));
  return fuse(at_identity(maps), 1.0).grid;
}

TEST(Fuse, AMapAloneStaysWhatItIs) {
  const OccupancyGrid map = map_from({"#.. ", "#.# ", "##.."}, 0.05, {-51.224998, 3.3, 0.0});
  const FusedMap fused = fuse({{&map, {}}}, 0.05);
  EXPECT_EQ(text_of(fused.grid), text_of(map));
  EXPECT_NEAR(fused.grid.origin.x, map.origin.x, 1e-12);
  EXPECT_NEAR(fused.grid.origin.y, map.origin.y, 1e-12);
  EXPECT_EQ(fused.grid.origin.theta, 0.0);
  EXPECT_EQ(fused.grid.resolution, 0.05);
  EXPECT_EQ(fused.agreeing, 0u);
  EXPECT_EQ(fused.conflicting, 0u);
  EXPECT_NO_THROW(validate(fused.grid));
}

TEST(Fuse, CoversAllInputsAndCountsWhatTheyShare) {
  const OccupancyGrid a = map_from({"#..#"});
  const OccupancyGrid b = map_from({"#.# #"});
  const FusedMap fused = fuse({{&a, {}}, {&b, {1.0, 0.0, 0.0}}}, 1.0);
  EXPECT_EQ(text_of(fused.grid), Rows{"##.# #"});
  EXPECT_EQ(fused.agreeing, 2u) << "a free cell and a wall";
  ASSERT_TRUE(fused.omega);
  EXPECT_EQ(fused.omega->cells, 6);
  EXPECT_EQ(fused.omega->equal, 3) << "what neither knows is equal too";
  EXPECT_EQ(fused.conflicting, 1u) << "a wall in free space";
}

TEST(Fuse, BlackPaintHidesNothingThatOthersHaveSeen) {
  // A room in a corner of a sheet that somebody painted black, and a map of what lies beside the room.
  OccupancyGrid sheet = make_grid(60, 60, 0.1, {}, Cell::occupied);
  for (int row = 2; row < 20; ++row)
    for (int column = 2; column < 20; ++column) sheet.at(column, row) = Cell::free;
  const OccupancyGrid beside = make_grid(20, 20, 0.1, {3.0, 0.0, 0.0}, Cell::free);
  const OccupancyGrid seen = internal::without_painted(sheet);
  ASSERT_LT(count_cells(seen).occupied, 300u);
  const FusedMap painted = fuse({{&sheet, {}}, {&beside, {}}}, 0.1);
  const FusedMap expected = fuse({{&seen, {}}, {&beside, {}}}, 0.1);
  EXPECT_EQ(painted.grid.cells, expected.grid.cells);
  EXPECT_EQ(painted.conflicting, 0u);
  EXPECT_EQ(count_cells(painted.grid).free, 18u * 18u + 20u * 20u);
  // Of a sheet that is black alone, nothing tells what was seen.
  const OccupancyGrid black = make_grid(8, 8, 0.1, {}, Cell::occupied);
  EXPECT_EQ(count_cells(fuse({{&black, {}}}, 0.1).grid).occupied, 64u);
}

TEST(Fuse, AddsLogOdds) {
  const auto log_odds = [](double p) { return std::log(p / (1.0 - p)); };
  const auto fused_log_odds = [&](const std::string& cells) {
    return log_odds(fuse_cells(cells).probability[0]);
  };
  EXPECT_NEAR(fused_log_odds("#"), log_odds(0.85), 1e-3);
  EXPECT_NEAR(fused_log_odds("."), log_odds(0.35), 1e-3);
  EXPECT_NEAR(fused_log_odds("#."), log_odds(0.85) + log_odds(0.35), 2e-3);
  EXPECT_NEAR(fused_log_odds("...."), 4 * log_odds(0.35), 4e-3);
}

TEST(Fuse, AWallOutlivesTwoMapsThatDidNotSeeIt) {
  EXPECT_EQ(fuse_cells("#..").cells[0], Cell::occupied);
  EXPECT_EQ(fuse_cells("#...").cells[0], Cell::free);
  EXPECT_EQ(fuse_cells("# ").cells[0], Cell::occupied);
  EXPECT_EQ(fuse_cells("  ").cells[0], Cell::unknown);
  EXPECT_TRUE(std::isnan(fuse_cells("  ").probability[0]));
}

TEST(Fuse, CertaintyIsLimited) {
  const float most = fuse_cells("###").probability[0];
  EXPECT_NEAR(most, 1.0 / (1.0 + std::exp(-3.5)), 1e-6);
  EXPECT_EQ(fuse_cells(std::string(500, '#')).probability[0], most);
  EXPECT_NEAR(fuse_cells(std::string(500, '.')).probability[0], 1.0 - most, 1e-6);
}

TEST(Fuse, TheLimitIsOnTheSumNotOnTheWay) {
  EXPECT_EQ(fuse_cells("###......").cells[0], Cell::occupied);
  EXPECT_EQ(fuse_cells("......###").cells[0], Cell::occupied);
}

TEST(Fuse, LogOddsThatCancelOutAreUnknown) {
  OccupancyGrid wall = map_from({"#"});
  OccupancyGrid space = map_from({"."});
  wall.probability = {0.75f};
  space.probability = {0.25f};
  const FusedMap fused = fuse(at_identity({wall, space}), 1.0);
  EXPECT_EQ(fused.grid.cells[0], Cell::unknown);
  EXPECT_TRUE(std::isnan(fused.grid.probability[0]));
  EXPECT_EQ(fused.conflicting, 1u);
}

TEST(Fuse, ThinWallsSurviveARotation) {
  OccupancyGrid map = make_grid(200, 100, 0.05, {1.0, 2.0, 0.3}, Cell::free);
  draw_line(map, 10, 10, 190, 10);
  draw_line(map, 190, 10, 190, 90);
  draw_line(map, 10, 10, 190, 90);
  for (int degrees = 0; degrees < 360; degrees += 30) {
    const OccupancyGrid fused = fuse({{&map, {3.3, -1.7, degrees * kPi / 180.0}}}, 0.05).grid;
    EXPECT_EQ(count_wall_pieces(fused), 1) << degrees;
    const auto walls = static_cast<double>(count_cells(fused).occupied);
    EXPECT_NEAR(walls / static_cast<double>(count_cells(map).occupied), 1.0, 0.25) << degrees << ": thin";
  }
}

TEST(Fuse, MixesResolutions) {
  const OccupancyGrid coarse = map_from({"#.", ".."}, 0.2);
  OccupancyGrid fine = make_grid(8, 8, 0.05, {}, Cell::free);
  draw_line(fine, 4, 0, 4, 7);
  for (const double resolution : {0.05, 0.2}) {
    const FusedMap fused = fuse(at_identity({coarse, fine}), resolution);
    const int scale = static_cast<int>(std::lround(0.2 / resolution));
    EXPECT_EQ(fused.grid.width, 2 * scale);
    EXPECT_EQ(fused.grid.at(0, 2 * scale - 1), Cell::occupied) << "the coarse map's wall";
    EXPECT_EQ(fused.grid.at(scale, 0), Cell::occupied) << "the fine map's wall";
    EXPECT_EQ(fused.grid.at(0, 0), Cell::free);
    EXPECT_EQ(fused.agreeing + fused.conflicting, fused.grid.cells.size());
  }
}

TEST(Fuse, RefusesWhatItCannotFuse) {
  EXPECT_THROW(fuse({}, 1.0), std::invalid_argument);
  const OccupancyGrid map = map_from({"#"});
  for (const double resolution : {0.0, -0.05, 0.5 * kMinResolution, 1.01 * kMaxResolution, std::nan("")})
    EXPECT_THROW(fuse({{&map, {}}}, resolution), std::invalid_argument) << resolution;
  EXPECT_THROW(fuse({{&map, {}}}, 1e-5), std::invalid_argument) << "10^10 cells";
  OccupancyGrid broken = map;
  broken.cells.clear();
  EXPECT_THROW(fuse({{&broken, {}}}, 1.0), std::invalid_argument);
}

OccupancyGrid any_map(std::mt19937& random) {
  const auto real = [&](double low, double high) {
    return std::uniform_real_distribution(low, high)(random);
  };
  const double resolution = real(0.0, 1.0) < 0.5 ? 0.1 : real(0.05, 0.3);
  OccupancyGrid map =
      make_grid(std::uniform_int_distribution(1, 30)(random), std::uniform_int_distribution(1, 30)(random),
                resolution, {real(-2.0, 2.0), real(-2.0, 2.0), real(-kPi, kPi)});
  for (Cell& cell : map.cells) cell = static_cast<Cell>(std::uniform_int_distribution(0, 2)(random));
  if (real(0.0, 1.0) < 0.3) {
    for (std::size_t i = 0; i < map.cells.size(); ++i)
      map.probability.push_back(static_cast<float>(real(0.0, 1.0)));
  }
  return map;
}

SE2 any_pose(std::mt19937& random) {
  const auto real = [&](double low, double high) {
    return std::uniform_real_distribution(low, high)(random);
  };
  if (real(0.0, 1.0) < 0.2) return {};
  return {real(-2.0, 2.0), real(-2.0, 2.0), real(-kPi, kPi)};
}

RC_GTEST_PROP(Fuse, TheOrderOfTheInputsDoesNotMatter, ()) {
  std::mt19937 random(*rc::gen::arbitrary<unsigned>());
  std::vector<OccupancyGrid> maps;
  for (int i = *rc::gen::inRange(1, 7); i > 0; --i) maps.push_back(any_map(random));
  std::vector<PlacedMap> inputs;
  for (const OccupancyGrid& map : maps) inputs.push_back({&map, any_pose(random)});
  const FusedMap fused = fuse(inputs, 0.1);
  std::shuffle(inputs.begin(), inputs.end(), random);
  const FusedMap other = fuse(inputs, 0.1);
  RC_ASSERT(fused.grid.origin == other.grid.origin);
  RC_ASSERT(fused.grid.width == other.grid.width);
  RC_ASSERT(fused.grid.cells == other.grid.cells);
  RC_ASSERT(fused.agreeing == other.agreeing);
  RC_ASSERT(fused.conflicting == other.conflicting);
  const std::size_t bytes = fused.grid.probability.size() * sizeof(float);
  RC_ASSERT(std::memcmp(fused.grid.probability.data(), other.grid.probability.data(), bytes) == 0);
}

// Cell by cell and input by input, as one would say it: log-odds of the cell under the centre, in floating
// point. Walls are two cells thick, so that the bands that join diagonal walls have no part in it.
RC_GTEST_PROP(Fuse, EqualsTheNaiveSum, ()) {
  std::mt19937 random(*rc::gen::arbitrary<unsigned>());
  std::vector<OccupancyGrid> maps{any_map(random), any_map(random), any_map(random)};
  std::vector<PlacedMap> inputs;
  for (OccupancyGrid& map : maps) {
    map.resolution = std::max(map.resolution, 0.1);
    map.probability.clear();
    for (int row = 0; row < map.height; ++row) {
      for (int column = 0; column < map.width; ++column) {
        Cell& cell = map.at(column, row);
        // Walls two cells thick, four apart: nothing touches at a corner only.
        if (cell == Cell::occupied) cell = Cell::free;
        if (column % 6 < 2) cell = Cell::occupied;
      }
    }
    // Of a small map more than half may be walls that no free cell is near to: fuse() takes them for paint.
    if (count_cells(map).free > 0 && internal::is_mostly_painted(map)) map = internal::without_painted(map);
    inputs.push_back({&map, any_pose(random)});
  }
  const FusedMap fused = fuse(inputs, 0.1);
  std::size_t known = 0;
  for (int row = 0; row < fused.grid.height; ++row) {
    for (int column = 0; column < fused.grid.width; ++column) {
      double sum = 0.0;
      for (const PlacedMap& input : inputs) {
        const Point2 p =
            inverse(input.T_output_map * input.map->origin) * fused.grid.cell_centre(column, row);
        const int x = static_cast<int>(std::floor(p.x / input.map->resolution + 1e-6));
        const int y = static_cast<int>(std::floor(p.y / input.map->resolution + 1e-6));
        if (!input.map->contains(x, y) || input.map->at(x, y) == Cell::unknown) continue;
        sum += input.map->at(x, y) == Cell::occupied ? std::log(0.85 / 0.15) : std::log(0.35 / 0.65);
      }
      const Cell expected = sum > 0 ? Cell::occupied : sum < 0 ? Cell::free : Cell::unknown;
      RC_ASSERT(fused.grid.at(column, row) == expected);
      if (expected == Cell::unknown) continue;
      ++known;
      RC_ASSERT(std::abs(fused.grid.probability[fused.grid.index(column, row)] -
                         1.0 / (1.0 + std::exp(-sum))) < 0.04);
    }
  }
  RC_ASSERT(known == count_cells(fused.grid).known());
}

/// Some lattice over a map of about 3 m x 3 m.
Deformation any_deformation(unsigned seed) {
  std::mt19937 random(seed);
  std::vector<Point2> shifts;
  for (int i = 0; i < 7 * 7; ++i) {
    const double x = static_cast<double>(random() % 1001) / 1000.0 - 0.5;
    const double y = static_cast<double>(random() % 1001) / 1000.0 - 0.5;
    shifts.push_back({0.25 * x, 0.25 * y});
  }
  return {{-0.5, -0.4, 0.3}, 1.0, 7, 7, shifts};
}

RC_GTEST_PROP(Fuse, BentMapsAreLookedUpWhereTheyComeFrom, ()) {
  const unsigned seed = *rc::gen::inRange(0U, 1000000U);
  std::mt19937 random(seed);
  OccupancyGrid map = make_grid(30, 30, 0.1, {0.2, -0.3, *rc::gen::inRange(-31, 31) / 10.0});
  for (Cell& cell : map.cells) cell = static_cast<Cell>(random() % 3);
  const Deformation deformation = any_deformation(seed);
  const SE2 T{1.0, 2.0, *rc::gen::inRange(-31, 31) / 10.0};
  const double resolution = *rc::gen::element(0.03, 0.1);
  const OccupancyGrid fused = fuse({{&map, T}}, resolution, {deformation}).grid;
  const SE2 T_grid_map = inverse(map.origin);
  int compared = 0;
  for (int row = 0; row < fused.height; ++row) {
    for (int column = 0; column < fused.width; ++column) {
      const Point2 in_map = deformation.straighten(inverse(T) * fused.cell_centre(column, row));
      const Point2 q = T_grid_map * in_map;
      const double x = q.x / map.resolution, y = q.y / map.resolution;
      const auto is_in_the_middle = [](double v) { return std::abs(v - std::floor(v) - 0.5) < 0.1; };
      if (!is_in_the_middle(x) || !is_in_the_middle(y)) continue;  // where a tenth of a cell changes nothing
      const int i = static_cast<int>(std::floor(x)), j = static_cast<int>(std::floor(y));
      RC_ASSERT(fused.at(column, row) == (map.contains(i, j) ? map.at(i, j) : Cell::unknown));
      ++compared;
    }
  }
  RC_ASSERT(compared > 5 || resolution > 0.05);  // a few large cells may all miss the middles
  // Nothing that the map knows lies beyond the result.
  for (int row = 0; row < map.height; ++row) {
    for (int column = 0; column < map.width; ++column) {
      if (map.at(column, row) == Cell::unknown) continue;
      const Point2 p = inverse(fused.origin) * (T * deformation.bend(map.cell_centre(column, row)));
      RC_ASSERT(fused.contains(static_cast<int>(std::floor(p.x / resolution)),
                               static_cast<int>(std::floor(p.y / resolution))));
    }
  }
}

TEST(Fuse, NoDeformationsAreTheSameAsNone) {
  const OccupancyGrid a = map_from({"#..#", "#. #"}), b = map_from({"#.# #"});
  const std::vector<PlacedMap> inputs{{&a, {}}, {&b, {1.0, 0.3, 0.7}}};
  const FusedMap none = fuse(inputs, 0.5), identities = fuse(inputs, 0.5, {Deformation(), Deformation()});
  EXPECT_EQ(none.grid.cells, identities.grid.cells);
  EXPECT_EQ(none.omega->equal, identities.omega->equal);
}

// Cells coarser than the map's: however it is squeezed, none of its walls is lost.
TEST(Fuse, ABentMapKeepsItsWallsInCoarserCells) {
  OccupancyGrid map = make_grid(60, 60, 0.05, {}, Cell::free);
  draw_line(map, 5, 5, 50, 30);
  const FusedMap fused = fuse({{&map, {}}}, 0.12, {any_deformation(3)});
  EXPECT_EQ(count_wall_pieces(fused.grid), 1);
}

TEST(BentMap, IsWhatFuseMakesOfIt) {
  OccupancyGrid map = make_grid(40, 30, 0.1, {0.2, -0.3, 0.0}, Cell::free);
  draw_line(map, 5, 5, 30, 20);
  map.probability.assign(map.cells.size(), 0.2F);
  const Deformation deformation = any_deformation(5);
  const OccupancyGrid bent = bent_map(map, deformation);
  const OccupancyGrid fused = fuse({{&map, {}}}, 0.1, {deformation}).grid;
  EXPECT_TRUE(bent.probability.empty());
  ASSERT_EQ(bent.width, fused.width);
  ASSERT_EQ(bent.height, fused.height);
  std::size_t differ = 0;
  for (std::size_t i = 0; i < bent.cells.size(); ++i) differ += bent.cells[i] != fused.cells[i] ? 1 : 0;
  EXPECT_LT(differ, bent.cells.size() / 50) << "cells at boundaries, for the frames are rounded differently";
  EXPECT_EQ(bent_map(map, {}).probability, map.probability);
}

}  // namespace
}  // namespace gridmerge
