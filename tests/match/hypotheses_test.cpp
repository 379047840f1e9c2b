// SPDX-License-Identifier: Apache-2.0
#include "match/hypotheses.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <set>
#include <string>

#include "gridmerge/match/match.hpp"
#include "match/prepared_map.hpp"
#include "match/refine.hpp"
#include "similarity/agreement.hpp"
#include "support/building.hpp"

namespace gridmerge {

using namespace internal;
namespace {

/// One empty hall of this side [m], with a wall around it.
OccupancyGrid hall(double side, double resolution = 0.1) {
  const int cells = static_cast<int>(std::lround(side / resolution));
  OccupancyGrid grid = make_grid(cells, cells, resolution, {}, Cell::free);
  for (int i = 0; i < cells; ++i) {
    for (const int edge : {0, cells - 1}) grid.at(i, edge) = grid.at(edge, i) = Cell::occupied;
  }
  return grid;
}

TEST(WorkingCell, GrowsWithTheMapsAsFarAsRoomsAndTimeAllow) {
  const auto cell = [](double side, double resolution) {
    // One row is enough: the longer side counts.
    OccupancyGrid strip =
        make_grid(static_cast<int>(std::lround(side / resolution)), 2, resolution, {}, Cell::free);
    strip.at(0, 0) = strip.at(strip.width - 1, 0) = Cell::occupied;
    const PreparedMap prepared(strip);
    EXPECT_EQ(working_cell(prepared, prepared), working_cell(prepared, PreparedMap(hall(3.0, resolution))));
    return working_cell(prepared, prepared);
  };
  EXPECT_DOUBLE_EQ(cell(40.0, 0.05), 0.05);   // 800 cells are few enough
  EXPECT_DOUBLE_EQ(cell(41.0, 0.05), 0.1);    // more are compared in larger ones
  EXPECT_DOUBLE_EQ(cell(150.0, 0.05), 0.1);   // but not in larger ones than walls allow,
  EXPECT_DOUBLE_EQ(cell(450.0, 0.05), 0.15);  // except for the sake of time
  EXPECT_DOUBLE_EQ(cell(100.0, 0.2), 0.2);
  EXPECT_DOUBLE_EQ(cell(50.0, 0.02), 0.08);
}

TEST(ChooseSearch, IsFinerForSmallMaps) {
  struct Expected {
    double side;  // [m], in cells of 0.1 m
    int coarse_factor;
    int rotations;
    double distinct;  // [cells]
  };
  // The root mean square distance of a square's outline from its middle is 1 / sqrt(3) of the side; a step
  // turns it by two coarse cells.
  const auto rotations = [](double side, int factor) {
    return static_cast<int>(std::ceil(std::numbers::pi * 10.0 * side / std::sqrt(3.0) / factor));
  };
  for (const Expected& expected : {Expected{10.0, 2, 180, 10.0},
                                   {20.0, 2, rotations(20.0, 2), 10.0},
                                   {40.0, 3, rotations(40.0, 3), 12.0},
                                   {60.0, 4, rotations(60.0, 4), 18.0},
                                   {160.0, 4, 720, 48.0}}) {
    const PreparedMap map(hall(expected.side));
    const ComparedMaps maps(map, map);
    const ExhaustiveSearchOptions search = choose_search(maps);
    EXPECT_EQ(search.coarse_factor, expected.coarse_factor) << expected.side;
    EXPECT_DOUBLE_EQ(search.sigma, 0.8 * expected.coarse_factor) << expected.side;
    EXPECT_NEAR(search.rotations, expected.rotations, 3) << expected.side;
    EXPECT_DOUBLE_EQ(distinct_displacement(maps), expected.distinct) << expected.side;
  }
}

TEST(ChooseSearch, TheLargerMapOfTwoDecides) {
  const PreparedMap large(hall(60.0)), small(hall(10.0));
  EXPECT_EQ(choose_search({large, small}).coarse_factor, 4);
  EXPECT_EQ(choose_search({small, large}).coarse_factor, 4);
  EXPECT_DOUBLE_EQ(distinct_displacement({large, small}), 18.0);
  EXPECT_DOUBLE_EQ(distinct_displacement({small, large}), 18.0);
}

TEST(Frames, OfMapsAndOfTheirCellsGoIntoEachOther) {
  const OccupancyGrid building = test::draw_building(1);
  const PreparedMap a(test::map_part(building, {0, 0, 12, 13}, {3.0, -2.0, 0.7}));
  const PreparedMap b(test::map_part(building, {5, 0, 18, 13}, {-1.0, 4.0, 2.0}));
  const ComparedMaps maps(a, b);
  const SE2 T{1.5, -0.75, 0.4};
  const SE2 T_cells = to_cells(T, maps.fixed_walls, maps.moving_walls);
  const SE2 back = to_map_frames(T_cells, maps.fixed_walls, maps.moving_walls);
  EXPECT_NEAR(back.x, T.x, 1e-9);
  EXPECT_NEAR(back.y, T.y, 1e-9);
  EXPECT_NEAR(back.theta, T.theta, 1e-12);
  // A wall of the moving map goes to one place, whichever way.
  const Point2 wall = maps.moving_walls.walls.front().position;
  const double cell = maps.cell;
  const Point2 in_map = T * (maps.moving_walls.T_map_grid * Point2{wall.x * cell, wall.y * cell});
  const Point2 in_cells = T_cells * wall;
  const Point2 expected = maps.fixed_walls.T_map_grid * Point2{in_cells.x * cell, in_cells.y * cell};
  EXPECT_NEAR(in_map.x, expected.x, 1e-9);
  EXPECT_NEAR(in_map.y, expected.y, 1e-9);
}

/// What speaks for a map laid on itself.
PoseFigures figures_on_itself(const OccupancyGrid& map) {
  const PreparedMap prepared(map);
  const ComparedMaps maps(prepared, prepared);
  return PoseJudge(maps).judge({}).figures;
}

TEST(PoseJudge, OfAMapOnItselfNothingIsAgainstIt) {
  const OccupancyGrid building = test::draw_building(1);
  const PoseFigures figures = figures_on_itself(building);
  EXPECT_EQ(figures.acceptance_index, 1.0);
  EXPECT_NEAR(figures.overlap, 1.0, 1e-9);
  EXPECT_NEAR(figures.common_area,
              static_cast<double>(count_cells(building).known()) * building.resolution * building.resolution,
              0.01 * figures.common_area);
  EXPECT_EQ(figures.walls_met, 1.0);
  EXPECT_EQ(figures.walls_met_locally, 1.0);
  EXPECT_GT(figures.score, figures.wall_score);
  EXPECT_GT(figures.held, 0.0);
  EXPECT_GE(figures.held_most, figures.held);
  EXPECT_DOUBLE_EQ(figures.sigma, 0.7 * building.resolution);  // the tightest model
  EXPECT_DOUBLE_EQ(figures.outliers, 0.02);
}

TEST(PoseJudge, CheapFiguresAreThoseOfAllFigures) {
  const OccupancyGrid building = test::draw_building(1);
  const PreparedMap left(test::map_part(building, {0, 0, 12, 13}, {1.0, 2.0, 0.5})),
      right(test::map_part(building, {5, 0, 18, 13}, {}));
  const ComparedMaps maps(left, right);
  const PoseJudge judge(maps);
  const std::set<std::string> dear{"walls_met",   "walls_met_locally", "wall_lines",
                                   "seen_things", "things_met",        "spread",
                                   "held",        "held_most",         "free_direction"};
  const std::set<std::string> of_rivals{"score_margin", "stands_out"};
  const SE2 T_true = to_cells({1.0, 2.0, 0.5}, maps.fixed_walls, maps.moving_walls);
  for (const SE2& off : {SE2{}, SE2{4.0, -7.0, 0.1}, SE2{-3.0, 11.0, 0.9}}) {
    const SE2 T = T_true * off;
    const PoseFigures cheap = judge.cheap_figures(T, judge.walls()(T)), all = judge.judge(T).figures;
    ASSERT_GT(all.common_area, 0.0);
    for (const PoseFigure& figure : pose_figures()) {
      const bool is_cheap = !dear.contains(figure.name) && !of_rivals.contains(figure.name);
      EXPECT_EQ(cheap.*figure.value, is_cheap ? all.*figure.value : 0.0) << figure.name;
    }
  }
}

TEST(PoseJudge, TellsLengthsInMetresWhateverTheCell) {
  // A wall of one cell is half as many cells where they are twice as large, and as many metres.
  const PoseFigures fine = figures_on_itself(hall(20.0, 0.1)), coarse = figures_on_itself(hall(20.0, 0.2));
  EXPECT_NEAR(coarse.seen_walls, fine.seen_walls, 0.05 * fine.seen_walls);
  EXPECT_NEAR(fine.seen_walls, 2 * 4 * 20.0, 0.05 * fine.seen_walls);  // those of either map
  EXPECT_NEAR(coarse.common_area, 400.0, 1e-6);
  EXPECT_NEAR(fine.common_area, 400.0, 1e-6);
  EXPECT_NEAR(coarse.spread, fine.spread, 0.05 * fine.spread);
  EXPECT_DOUBLE_EQ(coarse.sigma, 0.7 * 0.2);
}

TEST(PoseJudge, ACorridorIsHeldAcrossAndFreeAlong) {
  for (const double yaw : {0.0, 0.5, -1.2}) {
    OccupancyGrid corridor = make_grid(400, 30, 0.1, {2.0, 1.0, yaw}, Cell::free);
    for (int x = 0; x < 400; ++x) corridor.at(x, 2) = corridor.at(x, 27) = Cell::occupied;
    const PoseFigures figures = figures_on_itself(corridor);
    EXPECT_LT(figures.held, 0.1 * figures.held_most) << yaw;
    EXPECT_GT(figures.held_most, 50.0) << yaw;
    EXPECT_NEAR(undirected_angle(figures.free_direction - yaw), 0.0, 1e-6) << yaw;
  }
}

TEST(PoseJudge, SettlesCellOnCellWhereCellsCanLieSo) {
  const OccupancyGrid building = test::draw_building(1);
  OccupancyGrid moved = building;
  moved.origin = SE2{0.7, -0.4, 0.0} * moved.origin;  // seven and four cells
  const PreparedMap a(building), b(moved);
  const ComparedMaps maps(a, b);
  const PoseJudge judge(maps);
  const SE2 truth{-0.7, 0.4, 0.0};
  for (const SE2& off : {SE2{}, SE2{0.06, 0.0, 0.0}, SE2{-0.04, 0.07, 0.003}}) {
    const SE2 T_cells = to_cells(truth * off, maps.fixed_walls, maps.moving_walls);
    const Hypothesis settled = judge.settle(judge.judge(T_cells)).hypothesis;
    EXPECT_NEAR(settled.T_fixed_moving.x, truth.x, 1e-9);
    EXPECT_NEAR(settled.T_fixed_moving.y, truth.y, 1e-9);
    EXPECT_NEAR(settled.T_fixed_moving.theta, 0.0, 1e-12);
    EXPECT_EQ(settled.figures.acceptance_index, 1.0);
  }
}

TEST(PoseJudge, SettlesAPartOfAMapOnItsCells) {
  const OccupancyGrid building = test::draw_building(1);
  // Cut on all four sides, in frames of its own: whichever corner cells are counted from, the two differ
  // there.
  constexpr int kColumns = 17, kRows = 6;
  OccupancyGrid part =
      make_grid(building.width - kColumns - 8, building.height - kRows - 11, building.resolution);
  for (int row = 0; row < part.height; ++row) {
    for (int column = 0; column < part.width; ++column)
      part.at(column, row) = building.at(column + kColumns, row + kRows);
  }
  const SE2 T_grids{kColumns * building.resolution, kRows * building.resolution, 0.0};
  for (const SE2& origin : {SE2{}, SE2{3.0, -1.0, 0.0}, SE2{-2.0, 0.5, 0.5 * std::numbers::pi}}) {
    part.origin = origin;
    const PreparedMap a(building), b(part);
    const ComparedMaps maps(a, b);
    const PoseJudge judge(maps);
    const SE2 truth = building.origin * T_grids * inverse(origin);
    for (const SE2& off : {SE2{0.04, -0.03, 0.0}, SE2{-0.03, 0.05, 0.003}}) {
      const SE2 T_cells = to_cells(truth * off, maps.fixed_walls, maps.moving_walls);
      const Hypothesis settled = judge.settle(judge.judge(T_cells)).hypothesis;
      EXPECT_NEAR(settled.T_fixed_moving.x, truth.x, 1e-9);
      EXPECT_NEAR(settled.T_fixed_moving.y, truth.y, 1e-9);
      EXPECT_NEAR(normalize_angle(settled.T_fixed_moving.theta - truth.theta), 0.0, 1e-12);
      EXPECT_EQ(settled.figures.acceptance_index, 1.0);
    }
  }
}

/// The outer side of a thick wall says nothing of where a thin one lies in it: cells that agree do.
TEST(PoseJudge, SettlesOnTheCellsThatAgreeMost) {
  constexpr int kSide = 80, kThick = 5;
  OccupancyGrid thick = make_grid(kSide, kSide, 0.1, {}, Cell::free), thin = thick;
  for (int i = 0; i < kSide; ++i) {
    for (int depth = 0; depth < kThick; ++depth) thick.at(i, depth) = thick.at(depth, i) = Cell::occupied;
    for (int depth = 0; depth < kThick; ++depth) thin.at(i, depth) = thin.at(depth, i) = Cell::unknown;
  }
  for (int i = kThick; i < kSide; ++i) thin.at(i, kThick - 1) = thin.at(kThick - 1, i) = Cell::occupied;
  const PreparedMap a(thick), b(thin);
  const ComparedMaps maps(a, b);
  const PoseJudge judge(maps);
  for (const SE2& start : {SE2{}, SE2{-0.1, 0.0, 0.0}, SE2{-0.1, -0.1, 0.0}, SE2{0.1, 0.1, 0.0}}) {
    const Settled settled = judge.settle(judge.judge(to_cells(start, maps.fixed_walls, maps.moving_walls)));
    const SE2& found = settled.hypothesis.T_fixed_moving;
    EXPECT_NEAR(found.x, 0.0, 1e-9);
    EXPECT_NEAR(found.y, 0.0, 1e-9);
    EXPECT_NEAR(found.theta, 0.0, 1e-12);
  }
}

TEST(PoseJudge, StaysNearWhatItSettlesWhereMoreAgreesFartherAway) {
  // A wedge that grows thinner to the right: an empty room agrees more with every column that it moves there.
  constexpr int kColumns = 90, kRows = 40;
  OccupancyGrid wedge = make_grid(kColumns, kRows, 0.1, {}, Cell::free);
  for (int column = 0; column < kColumns; ++column) {
    for (int row = 0; row < (kColumns - column) / 3; ++row) wedge.at(column, row) = Cell::occupied;
  }
  const PreparedMap a(wedge), b(hall(3.0));
  const ComparedMaps maps(a, b);
  const PoseJudge judge(maps);
  const SE2 start{1.0, 0.5, 0.0};
  const Settled settled = judge.settle(judge.judge(to_cells(start, maps.fixed_walls, maps.moving_walls)));
  const SE2& found = settled.hypothesis.T_fixed_moving;
  EXPECT_LT(std::hypot(found.x - start.x, found.y - start.y), 0.5);
}

TEST(Weigh, PutsTheMostProbableFirstAndSaysByHowMuch) {
  const PreparedMap map(test::draw_building(1));
  const ComparedMaps maps(map, map);
  const PoseJudge judge(maps);
  std::vector<Hypothesis> hypotheses{judge.judge({40.0, 3.0, 0.5}), judge.judge({}),
                                     judge.judge({-35.0, 0.0, 2.0})};
  weigh(hypotheses, maps);
  EXPECT_LT(std::hypot(hypotheses[0].T_fixed_moving.x, hypotheses[0].T_fixed_moving.y), 0.01);
  EXPECT_GT(hypotheses[0].probability, 0.9);
  EXPECT_GT(hypotheses[0].figures.score_margin, 0.0);
  double sum = 0.0;
  for (std::size_t i = 0; i < hypotheses.size(); ++i) {
    sum += hypotheses[i].probability;
    EXPECT_LE(hypotheses[i].probability, hypotheses[i > 0 ? i - 1 : 0].probability);
  }
  EXPECT_LE(sum, 1.0 + 1e-12);
}

}  // namespace
}  // namespace gridmerge
