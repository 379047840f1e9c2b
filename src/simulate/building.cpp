// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "gridmerge/grid/execution.hpp"
#include "gridmerge/simulate/simulate.hpp"
#include "simulate/building_parts.hpp"
#include "simulate/floor_plan.hpp"
#include "simulate/surroundings.hpp"

namespace gridmerge {

using namespace internal;

namespace {

struct Kind {
  BuildingKind kind;
  const char* name;
  void (*draw)(Draughtsman&, Random&, double, double);
};

constexpr auto kKinds = std::to_array<Kind>({{BuildingKind::office, "office", draw_office},
                                             {BuildingKind::hall, "hall", draw_hall},
                                             {BuildingKind::warehouse, "warehouse", draw_warehouse},
                                             {BuildingKind::apartment, "apartment", draw_apartment},
                                             {BuildingKind::symmetric, "symmetric", draw_symmetric},
                                             {BuildingKind::loop, "loop", draw_loop},
                                             {BuildingKind::curved, "curved", draw_curved},
                                             {BuildingKind::outdoor, "outdoor", draw_outdoor},
                                             {BuildingKind::corridor, "corridor", draw_corridor},
                                             {BuildingKind::arena, "arena", draw_arena},
                                             {BuildingKind::maze, "maze", draw_maze},
                                             {BuildingKind::bare, "bare", draw_bare}});

}  // namespace

std::span<const BuildingKind> building_kinds() {
  static constexpr auto kAll = [] {
    std::array<BuildingKind, kKinds.size()> all{};
    for (std::size_t i = 0; i < all.size(); ++i) all[i] = kKinds[i].kind;
    return all;
  }();
  return kAll;
}

const char* name_of(BuildingKind kind) {
  return kKinds[static_cast<std::size_t>(kind)].name;
}

std::optional<BuildingKind> building_kind(std::string_view name) {
  for (const Kind& kind : kKinds) {
    if (name == kind.name) return kind.kind;
  }
  return std::nullopt;
}

void internal::validate_sides(double width, double height) {
  for (const double side : {width, height}) {
    if (!(side >= kMinBuildingSide && side <= kMaxBuildingSide))
      throw std::invalid_argument("a building's sides must be between 8 and 500 metres");
  }
}

Building make_building(BuildingKind kind, double width, double height, std::uint64_t seed) {
  validate_sides(width, height);
  if (static_cast<std::size_t>(kind) >= kKinds.size())
    throw std::invalid_argument("there is no such kind of building");
  Random random(seed);
  Draughtsman pen;
  kKinds[static_cast<std::size_t>(kind)].draw(pen, random, width, height);
  return {kind, width, height, std::move(pen.edges)};
}

void validate(const Building& building) {
  for (const double side : {building.width, building.height}) {
    if (!(side > 0.0 && side <= kMaxBuildingSide))
      throw std::invalid_argument("a building's sides must be positive, and at most 500 metres");
  }
  for (const Edge& edge : building.edges) {
    if (!is_near(building, edge.a) || !is_near(building, edge.b))
      throw std::invalid_argument("a building's edges must not end more than 500 metres beyond its sides");
    if (!(edge.echo >= 0.0 && edge.echo <= 1.0))
      throw std::invalid_argument("the echo of a building's edges must lie in [0, 1]");
  }
}

OccupancyGrid draw_building(const Building& building, double resolution) {
  validate(building);
  if (!(resolution >= 0.01 && resolution <= 1.0))
    throw std::invalid_argument("the resolution must be between 0.01 and 1 metres per cell");
  const FloorPlan plan(building.edges, 0.5 * FloorPlan::kCell);
  constexpr double kMargin = 1.0;  // [m]
  const auto cells = [&](double side) { return std::ceil((side + 2.0 * kMargin) / resolution); };
  const double columns = cells(building.width), rows = cells(building.height);
  if (columns * rows > kMaxGridCells)
    throw std::invalid_argument("the building's map would exceed 2^28 cells: a coarser resolution helps");
  OccupancyGrid grid =
      make_grid(static_cast<int>(columns), static_cast<int>(rows), resolution, {-kMargin, -kMargin, 0.0});
  const ManyPointsTransform T_building_grid(grid.origin);
  for (int row = 0; row < grid.height; ++row) {
    throw_if_cancelled();
    for (int column = 0; column < grid.width; ++column) {
      const int cell =
          plan.cell_at(T_building_grid * Point2{(column + 0.5) * resolution, (row + 0.5) * resolution});
      if (cell >= 0 && plan.is_free(cell)) grid.at(column, row) = Cell::free;
    }
  }
  for (const Edge& edge : building.edges) {
    const double length = std::hypot(edge.b.x - edge.a.x, edge.b.y - edge.a.y);
    const int pieces = std::max(1, static_cast<int>(2.0 * length / resolution));
    for (int i = 0; i <= pieces; ++i) {
      const double share = static_cast<double>(i) / pieces;
      const int column =
          static_cast<int>(std::floor((edge.a.x + share * (edge.b.x - edge.a.x) + kMargin) / resolution));
      const int row =
          static_cast<int>(std::floor((edge.a.y + share * (edge.b.y - edge.a.y) + kMargin) / resolution));
      if (grid.contains(column, row)) grid.at(column, row) = Cell::occupied;
    }
  }
  return grid;
}

}  // namespace gridmerge
