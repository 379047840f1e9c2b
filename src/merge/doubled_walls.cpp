// SPDX-License-Identifier: Apache-2.0
#include "merge/doubled_walls.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

#include "grid/parallel.hpp"
#include "gridmerge/match/match.hpp"
#include "match/drawn_walls.hpp"
#include "match/prepared_map.hpp"
#include "merge/elastic_walls.hpp"

namespace gridmerge::internal {

namespace {

constexpr std::size_t kWalls = 300;  // of each map, for each other map
constexpr double kReach = 1.0;       // [m]
constexpr double kApart = 0.2;       // [m]: what lies nearer is one wall
constexpr double kCellsApart = 2.0;  // and what lies within so many cells
constexpr double kMostAlong = 0.3;   // [m]: beyond that two are not the same piece of wall

/// Of the walls of `from` on those of `to`.
DoubledWalls compare(const ElasticWalls& from, const Member& from_member, const ElasticWalls& to,
                     const Member& to_member, double cell) {
  const std::vector<ElasticWall>& walls = from.walls();
  const std::size_t count = std::min(kWalls, walls.size());
  const SE2 turn{0.0, 0.0, from_member.T_component_map.theta - to_member.T_component_map.theta};
  DoubledWalls result;
  for (std::size_t i = 0; i < count; ++i) {
    ElasticWall wall = walls[i * walls.size() / count];
    wall.position = to_member.to_map(from_member.to_component(wall.position));
    wall.normal = turn * wall.normal;
    const ElasticWall* const nearest = to.nearest(wall, kReach);
    if (nearest == nullptr) continue;
    const Point2 gap{wall.position.x - nearest->position.x, wall.position.y - nearest->position.y};
    const Point2& normal = nearest->normal;
    if (std::abs(normal.x * gap.y - normal.y * gap.x) > kMostAlong) continue;
    result.compared += 1.0;
    if (std::abs(normal.x * gap.x + normal.y * gap.y) > std::max(kApart, kCellsApart * cell))
      result.doubled += 1.0;
  }
  return result;
}

}  // namespace

DoubledWalls measure_doubled_walls(const std::vector<OccupancyGrid>& maps, const Component& component) {
  const std::size_t count = component.members.size();
  std::vector<std::unique_ptr<const PreparedMap>> prepared(count);
  parallel_for(count, [&](std::size_t i) {
    prepared[i] = std::make_unique<const PreparedMap>(maps.at(component.members[i].map));
  });
  double cell = 0.0;
  for (const auto& map : prepared) cell = std::max(cell, working_cell(*map, *map));
  std::vector<std::unique_ptr<const ElasticWalls>> walls(count);
  parallel_for(count, [&](std::size_t i) {
    walls[i] = std::make_unique<const ElasticWalls>(DrawnWalls::of(*prepared[i], cell));
  });
  std::vector<DoubledWalls> of_each(count);
  parallel_for(count, [&](std::size_t i) {
    for (std::size_t j = 0; j < count; ++j) {
      if (j == i) continue;
      const DoubledWalls one =
          compare(*walls[i], component.members[i], *walls[j], component.members[j], cell);
      of_each[i].compared += one.compared;
      of_each[i].doubled += one.doubled;
    }
  });
  DoubledWalls all;
  for (const DoubledWalls& one : of_each) {
    all.compared += one.compared;
    all.doubled += one.doubled;
  }
  return all;
}

}  // namespace gridmerge::internal
