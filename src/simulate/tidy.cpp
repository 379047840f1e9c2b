// SPDX-License-Identifier: Apache-2.0
#include "simulate/tidy.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "gridmerge/grid/resample.hpp"

namespace gridmerge::internal {

namespace {

constexpr std::size_t kSpeck = 5;  // cells: what is smaller is dropped
constexpr float kOccupied = 0.9F, kFree = 0.1F;

void set(OccupancyGrid& map, int column, int row, Cell cell) {
  map.at(column, row) = cell;
  if (map.probability.empty()) return;
  const std::size_t at =
      static_cast<std::size_t>(row) * static_cast<std::size_t>(map.width) + static_cast<std::size_t>(column);
  map.probability[at] = cell == Cell::occupied ? kOccupied : kFree;
}

using Place = std::pair<int, int>;  // column, row

/// The occupied cells that hang together with this one; marks them as visited.
std::vector<Place> component(const OccupancyGrid& map, Place start, std::vector<bool>& visited) {
  const auto index = [&](int column, int row) {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(map.width) +
           static_cast<std::size_t>(column);
  };
  std::vector<Place> cells{start};
  visited[index(start.first, start.second)] = true;
  for (std::size_t next = 0; next < cells.size(); ++next) {
    const auto [x, y] = cells[next];
    for (int row = std::max(0, y - 1); row <= std::min(map.height - 1, y + 1); ++row) {
      for (int column = std::max(0, x - 1); column <= std::min(map.width - 1, x + 1); ++column) {
        if (map.at(column, row) != Cell::occupied || visited[index(column, row)]) continue;
        visited[index(column, row)] = true;
        cells.emplace_back(column, row);
      }
    }
  }
  return cells;
}

void drop_specks(OccupancyGrid& map) {
  std::vector<bool> visited(map.cells.size(), false);
  for (int row = 0; row < map.height; ++row) {
    for (int column = 0; column < map.width; ++column) {
      const std::size_t at = static_cast<std::size_t>(row) * static_cast<std::size_t>(map.width) +
                             static_cast<std::size_t>(column);
      if (map.cells[at] != Cell::occupied || visited[at]) continue;
      const std::vector<Place> cells = component(map, {column, row}, visited);
      if (cells.size() >= kSpeck) continue;
      for (const auto& [x, y] : cells) set(map, x, y, Cell::free);
    }
  }
}

/// The map with a rim of unknown cells.
OccupancyGrid with_rim(const OccupancyGrid& map, int rim) {
  const Point2 corner = map.origin * Point2{-rim * map.resolution, -rim * map.resolution};
  OccupancyGrid wide = make_grid(map.width + 2 * rim, map.height + 2 * rim, map.resolution,
                                 {corner.x, corner.y, map.origin.theta});
  if (!map.probability.empty()) wide.probability.assign(wide.cells.size(), std::nanf(""));
  for (int row = 0; row < map.height; ++row) {
    const std::size_t from = static_cast<std::size_t>(row) * static_cast<std::size_t>(map.width);
    const std::size_t to = static_cast<std::size_t>(row + rim) * static_cast<std::size_t>(wide.width) +
                           static_cast<std::size_t>(rim);
    std::copy_n(map.cells.begin() + static_cast<std::ptrdiff_t>(from), map.width,
                wide.cells.begin() + static_cast<std::ptrdiff_t>(to));
    if (!map.probability.empty())
      std::copy_n(map.probability.begin() + static_cast<std::ptrdiff_t>(from), map.width,
                  wide.probability.begin() + static_cast<std::ptrdiff_t>(to));
  }
  return wide;
}

}  // namespace

OccupancyGrid tidied(OccupancyGrid map, double thicken) {
  drop_specks(map);
  const int reach = static_cast<int>(std::lround(thicken / map.resolution));
  if (reach == 0) return map;
  const OccupancyGrid thin = with_rim(map, reach);
  OccupancyGrid thick = thin;
  for (int row = reach; row < thin.height - reach; ++row) {
    for (int column = reach; column < thin.width - reach; ++column) {
      if (thin.at(column, row) != Cell::occupied) continue;
      for (int dy = -reach; dy <= reach; ++dy) {
        for (int dx = -reach; dx <= reach; ++dx) {
          if (dx * dx + dy * dy <= reach * reach) set(thick, column + dx, row + dy, Cell::occupied);
        }
      }
    }
  }
  return crop_to_known(thick);
}

}  // namespace gridmerge::internal
