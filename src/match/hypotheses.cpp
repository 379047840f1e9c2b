// SPDX-License-Identifier: Apache-2.0
#include "match/hypotheses.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "grid/longer_side.hpp"
#include "match/drawn_walls.hpp"
#include "match/prepared_map.hpp"
#include "similarity/wall_lines.hpp"

namespace gridmerge::internal {

namespace {

/// Small maps are searched in finer steps, large ones in coarser: the search takes about the same time for
/// all.
constexpr double kCoarseCellsAlongSide = 150.0;
constexpr double kCoarseSigma = 0.8;  // tolerance of the search [coarse cells]
/// Steps of rotation move the walls by so much on average, within bounds.
constexpr double kTurnStep = 2.0;  // coarse cells
constexpr int kMinRotations = 180;
constexpr int kMaxRotations = 720;
/// Poses nearer than this share of the larger map's side, and never less than kMinDistinct, are one
/// hypothesis.
constexpr double kDistinctShare = 0.03;
constexpr double kMinDistinct = 10.0;  // cells
/// Poses nearer than so many times that are near each other: maps that are bent by a few per cent may lie in
/// either.
constexpr double kNearDistinct = 2.0;
/// About so many cells decide how much of the common area agrees.
constexpr double kRankedCells = 60000.0;

int stride_of_counted(const OccupancyGrid& grid) {
  return std::max(1, static_cast<int>(std::sqrt(static_cast<double>(grid.cells.size()) / kRankedCells)));
}

double known_area(const PreparedMap& map) {
  return static_cast<double>(map.counts().known()) * std::pow(map.known().resolution, 2);
}

/// The longest side of the two maps [cells].
double longest_side(const ComparedMaps& maps) {
  return std::max(longer_side(maps.fixed), longer_side(maps.moving)) / maps.cell;
}

}  // namespace

ComparedMaps::ComparedMaps(const PreparedMap& fixed_map, const PreparedMap& moving_map)
    : ComparedMaps(fixed_map, moving_map, working_cell(fixed_map, moving_map)) {}

ComparedMaps::ComparedMaps(const PreparedMap& fixed_map, const PreparedMap& moving_map, double cell_side)
    : fixed(fixed_map.known()),
      moving(moving_map.known()),
      cell(cell_side),
      smaller_area(std::min(known_area(fixed_map), known_area(moving_map))),
      fixed_walls(DrawnWalls::of(fixed_map, cell)),
      moving_walls(DrawnWalls::of(moving_map, cell)) {}

SE2 to_map_frames(const SE2& T_cells, const LikelihoodField& fixed, const LikelihoodField& moving) {
  const SE2 T_metres{T_cells.x * fixed.cell, T_cells.y * fixed.cell, T_cells.theta};
  return fixed.T_map_grid * T_metres * inverse(moving.T_map_grid);
}

SE2 to_cells(const SE2& T_fixed_moving, const LikelihoodField& fixed, const LikelihoodField& moving) {
  const SE2 T_metres = inverse(fixed.T_map_grid) * T_fixed_moving * moving.T_map_grid;
  return {T_metres.x / fixed.cell, T_metres.y / fixed.cell, T_metres.theta};
}

ExhaustiveSearchOptions choose_search(const ComparedMaps& maps) {
  ExhaustiveSearchOptions search;
  search.coarse_factor =
      std::clamp(static_cast<int>(std::ceil(longest_side(maps) / kCoarseCellsAlongSide)), 2, 4);
  search.sigma = kCoarseSigma * search.coarse_factor;
  const double radius = make_pose_metric(maps.moving_walls).radius / search.coarse_factor;
  search.rotations = std::clamp(static_cast<int>(std::ceil(2.0 * std::numbers::pi * radius / kTurnStep)),
                                kMinRotations, kMaxRotations);
  return search;
}

double distinct_displacement(const ComparedMaps& maps) {
  return std::max(kMinDistinct, kDistinctShare * longest_side(maps));
}

namespace {

constexpr double kFirstSettlingStep = 0.5;    // [cells]
constexpr double kLastSettlingStep = 0.0625;  // [cells]
constexpr std::size_t kSettlingWalls = 4000;
constexpr double kSnapWithin = 2.0;  // [cells]

constexpr double kSlide = 1.0;            // [m]
constexpr int kSlideDirections = 8;       // over half a turn
constexpr std::size_t kSlideWalls = 600;  // that are looked at

struct Hold {
  double least = 0.0, most = 0.0;  // nats per metre
  double direction = 0.0;          // of the least [rad, fixed grid frame]
};

Hold measure_hold(const WallEvidence& evidence, const SE2& T_cells, double cell) {
  Hold hold;
  const double here = evidence(T_cells).score;
  for (int i = 0; i < kSlideDirections; ++i) {
    const double angle = std::numbers::pi * i / kSlideDirections;
    const double dx = std::cos(angle) * kSlide / cell, dy = std::sin(angle) * kSlide / cell;
    const double there = std::max(evidence({T_cells.x + dx, T_cells.y + dy, T_cells.theta}).score,
                                  evidence({T_cells.x - dx, T_cells.y - dy, T_cells.theta}).score);
    const double lost = (here - there) / kSlide;
    if (i == 0 || lost < hold.least) {
      hold.least = lost;
      hold.direction = angle;
    }
    hold.most = i == 0 ? lost : std::max(hold.most, lost);
  }
  return hold;
}

}  // namespace

PoseJudge::PoseJudge(const ComparedMaps& maps)
    : maps_(maps),
      metric_(make_pose_metric(maps.moving_walls)),
      walls_(maps.fixed_walls, maps.moving_walls, std::numeric_limits<std::size_t>::max()),
      settling_walls_(walls_.with_points(kSettlingWalls)),
      sliding_walls_(walls_.with_points(kSlideWalls)),
      cells_(maps.fixed, maps.moving, stride_of_counted(maps.moving)),
      patches_(maps.moving_walls) {}

PoseFigures PoseJudge::cheap_figures(const SE2& T_cells, const Evidence& walls) const {
  const AgreementCounts common = cells_.count(to_map_frames(T_cells, maps_.fixed_walls, maps_.moving_walls));
  const double cells_per_cell = std::pow(maps_.moving.resolution / maps_.cell, 2);
  PoseFigures figures;
  figures.score = walls.score + area_evidence(cells_per_cell * static_cast<double>(common.agreement),
                                              cells_per_cell * static_cast<double>(common.disagreement));
  figures.wall_score = walls.score;
  figures.seen_walls = walls.seen_walls * maps_.cell;
  figures.acceptance_index = common.acceptance_index();
  figures.common_area =
      static_cast<double>(common.both_known()) * maps_.moving.resolution * maps_.moving.resolution;
  figures.overlap = maps_.smaller_area > 0.0 ? std::min(1.0, figures.common_area / maps_.smaller_area) : 0.0;
  figures.sigma = walls.model.sigma * maps_.cell;
  figures.outliers = walls.model.outliers;
  return figures;
}

PoseFigures PoseJudge::figures(const SE2& T_cells) const {
  const LikelihoodField &fixed = maps_.fixed_walls, &moving = maps_.moving_walls;
  const double cell = maps_.cell;
  const WallSupport support = measure_wall_support(fixed, moving, T_cells);
  const WallsMet met = measure_walls_met(fixed, patches_, T_cells);
  const Hold hold = measure_hold(sliding_walls_, T_cells, cell);

  PoseFigures figures = cheap_figures(T_cells, walls_(T_cells));
  figures.walls_met = met.rigidly;
  figures.walls_met_locally = met.locally;
  figures.wall_lines = support.lines;
  figures.seen_things = met.seen_things * cell;
  figures.things_met = met.things_met;
  figures.spread = support.spread * cell;
  figures.held = hold.least;
  figures.held_most = hold.most;
  figures.free_direction = undirected_angle(hold.direction + fixed.T_map_grid.theta);
  return figures;
}

Hypothesis PoseJudge::judge(const SE2& T_cells) const {
  const PoseFigures found = figures(T_cells);
  return {to_map_frames(T_cells, maps_.fixed_walls, maps_.moving_walls), found.score, 0.0, found};
}

std::optional<PoseJudge::CellOnCell> PoseJudge::best_cell_on_cell(const SE2& T_cells) const {
  const OccupancyGrid &fixed = maps_.fixed, &moving = maps_.moving;
  if (fixed.resolution != moving.resolution) return std::nullopt;
  const SE2 T_grids =
      inverse(fixed.origin) * to_map_frames(T_cells, maps_.fixed_walls, maps_.moving_walls) * moving.origin;
  const double quarters = std::round(T_grids.theta / (0.5 * std::numbers::pi));
  const auto between_maps = [&](double column, double row) {
    const SE2 T{column * fixed.resolution, row * fixed.resolution,
                normalize_angle(quarters * 0.5 * std::numbers::pi)};
    // Said exactly, since the product of a pose and its inverse need not be.
    return T == SE2{} && fixed.origin == moving.origin ? SE2{} : fixed.origin * T * inverse(moving.origin);
  };
  const auto is_near = [&](const SE2& T_fixed_moving) {
    return metric_.displacement(T_cells, to_cells(T_fixed_moving, maps_.fixed_walls, maps_.moving_walls)) <
           kSnapWithin;
  };
  double column = std::round(T_grids.x / fixed.resolution), row = std::round(T_grids.y / fixed.resolution);
  SE2 best = between_maps(column, row);
  if (!is_near(best)) return std::nullopt;
  double most = agreement(best);
  for (bool improved = true; improved;) {
    improved = false;
    const double from_column = column, from_row = row;
    for (int i = 0; i < 9; ++i) {
      const int right = i % 3 - 1, up = i / 3 - 1;
      const double next_column = from_column + right, next_row = from_row + up;
      const SE2 next = between_maps(next_column, next_row);
      // Farther away the share that agrees may be larger, of cells that are fewer.
      if (!is_near(next)) continue;
      const double agreeing = agreement(next);
      if (agreeing <= most) continue;
      most = agreeing;
      best = next;
      column = next_column;
      row = next_row;
      improved = true;
    }
  }
  return CellOnCell{best, most};
}

Settled PoseJudge::settle(const Hypothesis& hypothesis) const {
  const SE2 T_cells = to_cells(hypothesis.T_fixed_moving, maps_.fixed_walls, maps_.moving_walls);
  const SE2 climbed =
      climb(settling_walls_, metric_, T_cells, kFirstSettlingStep, kLastSettlingStep).T_fixed_moving;
  std::optional<CellOnCell> best;
  for (const SE2& from : {T_cells, climbed}) {
    const std::optional<CellOnCell> found = best_cell_on_cell(from);
    if (found && (!best || found->agreement > best->agreement)) best = found;
  }
  if (!best || best->agreement < agreement(to_map_frames(climbed, maps_.fixed_walls, maps_.moving_walls)))
    return {judge(climbed), false};
  Hypothesis settled = judge(to_cells(best->T_fixed_moving, maps_.fixed_walls, maps_.moving_walls));
  settled.T_fixed_moving = best->T_fixed_moving;
  return {settled, true};
}

double PoseJudge::agreement(const SE2& T_fixed_moving) const {
  return cells_.count(T_fixed_moving).acceptance_index();
}

std::vector<PoseFigures> figures_of(const std::vector<Hypothesis>& hypotheses) {
  std::vector<PoseFigures> figures;
  figures.reserve(hypotheses.size());
  for (const Hypothesis& hypothesis : hypotheses) figures.push_back(hypothesis.figures);
  return figures;
}

std::vector<PoseFigures> compared_figures(const std::vector<Hypothesis>& hypotheses,
                                          const ComparedMaps& maps) {
  const PoseMetric metric = make_pose_metric(maps.moving_walls);
  const double near = kNearDistinct * distinct_displacement(maps);
  std::vector<PoseFigures> figures = figures_of(hypotheses);
  std::vector<SE2> T_cells;
  T_cells.reserve(hypotheses.size());
  for (const Hypothesis& hypothesis : hypotheses)
    T_cells.push_back(to_cells(hypothesis.T_fixed_moving, maps.fixed_walls, maps.moving_walls));
  compare_rivals(figures, [&](std::size_t a, std::size_t b) {
    return metric.displacement(T_cells[a], T_cells[b]) < near;
  });
  return figures;
}

void weigh(std::vector<Hypothesis>& hypotheses, const ComparedMaps& maps) {
  weigh_by(rigid_model(), compared_figures(hypotheses, maps), hypotheses);
}

void weigh_by(const VerdictModel& model, const std::vector<PoseFigures>& figures,
              std::vector<Hypothesis>& hypotheses) {
  const std::vector<double> probabilities = probabilities_of(figures, model);
  for (std::size_t i = 0; i < hypotheses.size(); ++i) {
    hypotheses[i].figures = figures[i];
    hypotheses[i].probability = probabilities[i];
  }
  std::stable_sort(hypotheses.begin(), hypotheses.end(),
                   [](const Hypothesis& a, const Hypothesis& b) { return a.probability > b.probability; });
}

}  // namespace gridmerge::internal
