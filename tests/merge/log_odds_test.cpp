// SPDX-License-Identifier: Apache-2.0
#include "merge/log_odds.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <vector>

#include "merge/drawing.hpp"

namespace gridmerge {

using namespace internal;
namespace {

using test::count_wall_pieces;
using test::draw_line;
using test::map_from;

constexpr double kPi = std::numbers::pi;
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

// The fixed log-odds of a map without probabilities.
const auto kOccupied = static_cast<std::int16_t>(std::lround(std::log(0.85 / 0.15) * kLogOddsPerNat));
const auto kFree = static_cast<std::int16_t>(std::lround(std::log(0.35 / 0.65) * kLogOddsPerNat));

LogOddsPatch draw(const OccupancyGrid& map, const SE2& T_output_map, double resolution) {
  return draw_log_odds({&map, T_output_map}, cover({{&map, T_output_map}}, resolution));
}

TEST(Cover, HoldsJustTheKnownCells) {
  const OccupancyGrid map = map_from({"    ", " .# ", " .  ", "    "}, 0.5, {10.0, 20.0, 0.0});
  const Lattice lattice = cover({{&map, {}}}, 0.5);
  EXPECT_EQ(lattice.width, 2);
  EXPECT_EQ(lattice.height, 2);
  EXPECT_DOUBLE_EQ(lattice.corner.x, 10.5);
  EXPECT_DOUBLE_EQ(lattice.corner.y, 20.5);
}

TEST(Cover, HoldsRotatedCells) {
  const OccupancyGrid map = map_from({"#"}, 1.0, {5.0, 0.0, kPi / 4});
  const Lattice lattice = cover({{&map, {0.0, 1.0, 0.0}}}, 0.1);
  EXPECT_NEAR(lattice.corner.x, 5.0 - std::sqrt(0.5), 1e-9);
  EXPECT_NEAR(lattice.corner.y, 1.0, 1e-9);
  EXPECT_EQ(lattice.width, 15);
  EXPECT_EQ(lattice.height, 15);
}

TEST(Cover, ContinuesTheCellsOfTheMapThatGivesTheFrame) {
  const OccupancyGrid frame = map_from({"#"}, 1.0, {0.25, 0.75, 0.0});
  const OccupancyGrid other = map_from({"#"}, 1.0, {-3.5, -1.5, 0.0});
  const SE2 T{0.1, 0.0, 0.0};
  for (const Lattice& lattice :
       {cover({{&frame, {}}, {&other, T}}, 1.0), cover({{&other, T}, {&frame, {}}}, 1.0)}) {
    EXPECT_DOUBLE_EQ(lattice.corner.x, -3.75);
    EXPECT_DOUBLE_EQ(lattice.corner.y, -2.25);
    EXPECT_EQ(lattice.width, 5);
    EXPECT_EQ(lattice.height, 4);
  }
  EXPECT_DOUBLE_EQ(cover({{&frame, T}, {&other, T}}, 1.0).corner.x, -3.4);
}

TEST(Cover, IsOneCellWhenNothingIsKnown) {
  const OccupancyGrid map = make_grid(50, 50, 0.05);
  const Lattice lattice = cover({{&map, {}}}, 0.1);
  EXPECT_EQ(lattice.width * lattice.height, 1);
  EXPECT_EQ(lattice.resolution, 0.1);
  EXPECT_TRUE(draw_log_odds({&map, {}}, lattice).log_odds.empty());
}

TEST(Cover, RefusesWhatItCannotCover) {
  const OccupancyGrid map = map_from({"#"});
  for (const double resolution : {0.0, -1.0, kNaN, HUGE_VAL}) {
    EXPECT_THROW(cover({{&map, {}}}, resolution), std::invalid_argument) << resolution;
  }
  EXPECT_THROW(cover({{&map, {kNaN, 0.0, 0.0}}}, 1.0), std::invalid_argument);
  EXPECT_THROW(cover({{&map, {0.0, HUGE_VAL, 0.0}}}, 1.0), std::invalid_argument);
  EXPECT_THROW(cover({{nullptr, {}}}, 1.0), std::invalid_argument);
  EXPECT_THROW(cover({{&map, {}}, {&map, {20000.0, 20000.0, 0.0}}}, 1.0), std::invalid_argument);
  EXPECT_THROW(cover({{&map, {1e308, 0.0, 0.0}}, {&map, {-1e308, 0.0, 0.0}}}, 1.0), std::invalid_argument);
  const OccupancyGrid far_apart = map_from({"#"}, 1e-300);
  EXPECT_THROW(cover({{&map, {}}, {&far_apart, {}}}, 1e-300), std::invalid_argument);
}

TEST(DrawLogOdds, CopiesAMapThatLiesOnTheLattice) {
  for (const double shift : {0.0, 0.3, 12345.678}) {
    const OccupancyGrid map = map_from({"#. ", ".#.", "  #"}, 0.05, {shift, -shift, 0.0});
    const LogOddsPatch patch = draw(map, {}, 0.05);
    ASSERT_EQ(patch.width, 3);
    ASSERT_EQ(patch.height, 3);
    for (int row = 0; row < 3; ++row) {
      for (int column = 0; column < 3; ++column) {
        const Cell cell = map.at(column, row);
        const std::int16_t expected = cell == Cell::occupied ? kOccupied
                                      : cell == Cell::free   ? kFree
                                                             : std::int16_t{0};
        EXPECT_EQ(patch.at(column, row), expected) << column << ", " << row;
      }
    }
  }
}

TEST(DrawLogOdds, AppliesTransformAndOriginYaw) {
  // Column by column, a yaw of 90 degrees lays the row "#.." upwards, and the transform's turns it to the
  // left.
  const OccupancyGrid map = map_from({"#.."}, 1.0, {7.0, 3.0, kPi / 2});
  const LogOddsPatch patch = draw(map, {0.0, 0.0, kPi / 2}, 1.0);
  ASSERT_EQ(patch.width, 3);
  ASSERT_EQ(patch.height, 1);
  EXPECT_GT(patch.at(2, 0), 0);
  EXPECT_LT(patch.at(0, 0), 0);
}

TEST(DrawLogOdds, NoWallIsLostWhenCentresFallOnCellBoundaries) {
  // Half a cell off in both directions: every centre lies on a corner of the map's cells, but for rounding.
  OccupancyGrid map = make_grid(100, 100, 0.05, {}, Cell::free);
  for (int i = 0; i < 100; i += 2) draw_line(map, i, 0, i, 99);
  for (int k = 0; k < 40; ++k) {
    map.origin = {-51.225 + 0.35 * k, 10.1 * k, kPi / 2 * (k % 4)};
    const Lattice around = cover({{&map, {}}}, 0.05);
    const Lattice lattice{102, 102, 0.05, {around.corner.x - 0.025, around.corner.y - 0.025}};
    const LogOddsPatch patch = draw_log_odds({&map, {}}, lattice);
    const auto walls =
        std::count_if(patch.log_odds.begin(), patch.log_odds.end(), [](auto e) { return e > 0; });
    EXPECT_EQ(walls, 50 * 100) << k;
  }
}

TEST(DrawLogOdds, ProbabilitySetsTheStrengthAndTheCellTheSign) {
  OccupancyGrid map = map_from({"##..# #."});
  const float nan = std::numeric_limits<float>::quiet_NaN();
  map.probability = {0.7f, 1.0f, 0.3f, 0.0f, nan, 0.9f, 0.4f, 0.5f};
  const LogOddsPatch patch = draw(map, {}, 1.0);
  const auto log_odds = [](double p) { return std::lround(std::log(p / (1.0 - p)) * kLogOddsPerNat); };
  EXPECT_EQ(patch.at(0, 0), log_odds(0.7f));
  EXPECT_EQ(patch.at(1, 0), log_odds(0.88));
  EXPECT_EQ(patch.at(2, 0), log_odds(0.3f));
  EXPECT_EQ(patch.at(3, 0), log_odds(0.12));
  EXPECT_EQ(patch.at(4, 0), kOccupied);
  EXPECT_EQ(patch.at(5, 0), 0);
  EXPECT_EQ(patch.at(6, 0), 1);
  EXPECT_EQ(patch.at(7, 0), -1);
}

TEST(DrawLogOdds, ManyFineCellsAreOneStatement) {
  const OccupancyGrid map = make_grid(80, 80, 0.05, {}, Cell::free);
  const LogOddsPatch patch = draw(map, {}, 0.4);
  ASSERT_EQ(patch.width, 10);
  ASSERT_EQ(patch.height, 10);
  for (const std::int16_t log_odds : patch.log_odds) EXPECT_EQ(log_odds, kFree);
}

TEST(DrawLogOdds, FineCellsSayTheStrongestOccupiedElseTheWeakestFree) {
  OccupancyGrid map = map_from({"##..", "##..", "....", ". ..", "    ", "    "});
  map.probability.assign(24, 0.3f);
  for (const std::size_t i : {16u, 17u, 20u}) map.probability[i] = 0.6f;
  map.probability[21] = 0.8f;  // occupied, the strongest
  map.probability[8] = 0.45f;  // free, the weakest of its three
  const LogOddsPatch patch = draw_log_odds({&map, {}}, {2, 3, 2.0, {}});
  const auto log_odds = [](double p) { return std::lround(std::log(p / (1.0 - p)) * kLogOddsPerNat); };
  EXPECT_EQ(patch.at(0, patch.height - 1), log_odds(0.8f));
  EXPECT_EQ(patch.at(1, patch.height - 1), log_odds(0.3f));
  EXPECT_EQ(patch.at(0, patch.height - 2), log_odds(0.45f));
  EXPECT_EQ(patch.row + patch.height, 3);
}

TEST(DrawLogOdds, ABentMapInFarCoarserCellsKeepsItsWalls) {
  OccupancyGrid map = make_grid(400, 300, 0.01, {}, Cell::free);
  draw_line(map, 50, 50, 350, 250);
  const Deformation bends({-1.0, -1.0, 0.0}, 2.0, 6, 6, [] {
    std::vector<Point2> shifts(36);
    for (std::size_t i = 0; i < shifts.size(); ++i)
      shifts[i] = {i % 3 == 0 ? 0.05 : 0.0, i % 4 == 1 ? 0.04 : 0.0};
    return shifts;
  }());
  for (const double resolution : {0.025, 0.05, 0.1, 1.0, 100.0, 1e12}) {
    const std::vector<PlacedMap> maps{{&map, {3.0, 1.0, 0.7}}};
    const Lattice lattice = cover(maps, resolution, {bends});
    const LogOddsPatch patch = draw_log_odds(maps[0], lattice, bends);
    // Each wall cell is in a cell of the lattice that says so.
    for (int row = 0; row < map.height; ++row) {
      for (int column = 0; column < map.width; ++column) {
        if (map.at(column, row) != Cell::occupied) continue;
        const Point2 p = maps[0].T_output_map * bends.bend(map.cell_centre(column, row));
        const int x = static_cast<int>(std::floor((p.x - lattice.corner.x) / resolution + 1e-6));
        const int y = static_cast<int>(std::floor((p.y - lattice.corner.y) / resolution + 1e-6));
        ASSERT_GT(patch.at(x - patch.column, y - patch.row), 0) << resolution;
      }
    }
    // And within the map nothing is unknown.
    const SE2 T_map_output = inverse(maps[0].T_output_map);
    for (int y = 0; y < patch.height; ++y) {
      for (int x = 0; x < patch.width; ++x) {
        const Point2 centre{lattice.corner.x + (patch.column + x + 0.5) * resolution,
                            lattice.corner.y + (patch.row + y + 0.5) * resolution};
        const Point2 p = bends.straighten(T_map_output * centre);
        if (p.x < resolution || p.y < resolution || p.x > 4.0 - resolution || p.y > 3.0 - resolution)
          continue;
        ASSERT_NE(patch.at(x, y), 0) << resolution;
      }
    }
  }
}

TEST(DrawLogOdds, CoarseCellsAreSpreadOverTheLattice) {
  const OccupancyGrid map = map_from({"#."}, 0.2);
  const LogOddsPatch patch = draw(map, {}, 0.05);
  ASSERT_EQ(patch.width, 8);
  ASSERT_EQ(patch.height, 4);
  for (int row = 0; row < 4; ++row) {
    for (int column = 0; column < 8; ++column)
      EXPECT_EQ(patch.at(column, row), column < 4 ? kOccupied : kFree);
  }
}

TEST(DrawLogOdds, OneLatticeCellMayHoldAWholeMap) {
  const OccupancyGrid map = map_from({"..", ".#"}, 1e-6);
  const LogOddsPatch patch = draw_log_odds({&map, {}}, {1, 1, 1e300, {}});
  ASSERT_EQ(patch.log_odds.size(), 1u);
  EXPECT_EQ(patch.at(0, 0), kOccupied);
}

TEST(DrawLogOdds, OutsideOfTheLatticeIsCutOff) {
  const OccupancyGrid map = make_grid(10, 10, 1.0, {}, Cell::occupied);
  const Lattice lattice{4, 3, 1.0, {8.0, -1.0}};
  const LogOddsPatch patch = draw_log_odds({&map, {}}, lattice);
  EXPECT_LE(patch.column + patch.width, lattice.width);
  EXPECT_LE(patch.row + patch.height, lattice.height);
  EXPECT_EQ(std::count(patch.log_odds.begin(), patch.log_odds.end(), kOccupied), 2 * 2);
  const LogOddsPatch coarse = draw_log_odds({&map, {}}, {2, 2, 2.0, {8.0, 8.0}});
  EXPECT_EQ(std::count(coarse.log_odds.begin(), coarse.log_odds.end(), kOccupied), 1);
  EXPECT_TRUE(draw_log_odds({&map, {}}, {4, 3, 1.0, {100.0, 0.0}}).log_odds.empty());
}

TEST(DrawLogOdds, InnerCornersAreNotFilled) {
  const OccupancyGrid map = map_from({"#....", "#....", "#....", "#####"});
  const LogOddsPatch patch = draw(map, {}, 0.1);
  const auto occupied =
      std::count_if(patch.log_odds.begin(), patch.log_odds.end(), [](auto e) { return e > 0; });
  EXPECT_EQ(occupied, 8 * 100);
}

// A straight wall, one cell thick and at least two long, at any slope, drawn at any pose.
struct DrawnLine {
  OccupancyGrid map = make_grid(60, 60, 0.05, {}, Cell::free);
  SE2 T_output_map;
};

DrawnLine any_line() {
  const auto coordinate = [] { return *rc::gen::inRange(1, 59); };
  const auto real = [](double low, double high) {
    return low + (high - low) * *rc::gen::inRange(0, 100000) / 1e5;
  };
  DrawnLine line;
  const int x = coordinate(), y = coordinate(), to_x = coordinate(), to_y = coordinate();
  RC_PRE(x != to_x || y != to_y);
  draw_line(line.map, x, y, to_x, to_y);
  line.map.origin = {real(-1.0, 1.0), real(-1.0, 1.0), real(-kPi, kPi)};
  line.T_output_map = {real(-1.0, 1.0), real(-1.0, 1.0), real(-kPi, kPi)};
  return line;
}

RC_GTEST_PROP(DrawLogOdds, AThinWallStaysInOnePieceAtAnyPose, ()) {
  const DrawnLine line = any_line();
  RC_ASSERT(count_wall_pieces(draw(line.map, line.T_output_map, 0.05)) == 1);
}

RC_GTEST_PROP(DrawLogOdds, AThinWallStaysInOnePieceAtAnyResolution, ()) {
  const DrawnLine line = any_line();
  const double resolution = 0.001 * *rc::gen::inRange(25, 400);
  RC_ASSERT(count_wall_pieces(draw(line.map, line.T_output_map, resolution)) == 1);
}

RC_GTEST_PROP(DrawLogOdds, AKnownAreaHasNoHolesAtAnyResolution, ()) {
  const DrawnLine pose = any_line();
  const double resolution = 0.001 * *rc::gen::inRange(25, 400);
  const LogOddsPatch patch = draw(pose.map, pose.T_output_map, resolution);
  for (int row = 0; row < patch.height; ++row) {
    int runs = 0;
    for (int column = 0; column < patch.width; ++column) {
      if (patch.at(column, row) != 0 && (column == 0 || patch.at(column - 1, row) == 0)) ++runs;
    }
    RC_ASSERT(runs <= 1);
  }
}

}  // namespace
}  // namespace gridmerge
