// SPDX-License-Identifier: Apache-2.0
#include "gridmerge/similarity/wall_map.hpp"

#include <algorithm>
#include <cmath>

#include "gridmerge/grid/resample.hpp"

namespace gridmerge {

namespace {

constexpr int kMargin = 4;       // cells around the known area, so that distances reach beyond its rim
constexpr int kSeenReach = 2;    // cells beyond a known one that still count as seen
constexpr int kChamferStep = 3;  // distance units of one cell
constexpr int kChamferDiagonal = 4;
constexpr std::uint16_t kFar = 60000;

/// In place: 0 where the input is 0, elsewhere the chamfer distance to the nearest 0. The border must be
/// kFar.
void chamfer_distance(std::vector<std::uint16_t>& distance, int width, int height) {
  const auto relax = [&](std::size_t i, std::ptrdiff_t side, std::ptrdiff_t row) {
    const int straight = std::min<int>(distance[i + side], distance[i + row]) + kChamferStep;
    const int diagonal = std::min<int>(distance[i + row - 1], distance[i + row + 1]) + kChamferDiagonal;
    distance[i] = static_cast<std::uint16_t>(std::min({static_cast<int>(distance[i]), straight, diagonal}));
  };
  for (int y = 1; y < height; ++y) {
    for (int x = 1; x + 1 < width; ++x) relax(static_cast<std::size_t>(y) * width + x, -1, -width);
  }
  for (int y = height - 2; y >= 0; --y) {
    for (int x = width - 2; x > 0; --x) relax(static_cast<std::size_t>(y) * width + x, 1, width);
  }
}

struct WallSum {
  float x = 0.0F;
  float y = 0.0F;
  int count = 0;
};

}  // namespace

WallMap make_wall_map(const OccupancyGrid& uncropped, double cell) {
  const OccupancyGrid grid = crop_to_known(uncropped);
  const double scale = grid.resolution / cell;

  WallMap map;
  map.cell = cell;
  map.width = static_cast<int>(std::ceil(grid.width * scale)) + 2 * kMargin;
  map.height = static_cast<int>(std::ceil(grid.height * scale)) + 2 * kMargin;
  const Point2 corner = grid.origin * Point2{-kMargin * cell, -kMargin * cell};
  map.T_map_grid = {corner.x, corner.y, grid.origin.theta};

  const std::size_t size = static_cast<std::size_t>(map.width) * map.height;
  std::vector<WallSum> walls(size);
  std::vector<std::uint16_t> to_wall(size, kFar);
  std::vector<std::uint16_t> to_known(size, kFar);
  std::vector<int> cell_x(grid.width);
  for (int column = 0; column < grid.width; ++column)
    cell_x[column] = static_cast<int>((column + 0.5) * scale) + kMargin;
  for (int row = 0; row < grid.height; ++row) {
    const double y = (row + 0.5) * scale + kMargin;
    const std::size_t line = static_cast<std::size_t>(y) * map.width;
    for (int column = 0; column < grid.width; ++column) {
      const Cell value = grid.at(column, row);
      if (value == Cell::unknown) continue;
      const std::size_t i = line + cell_x[column];
      to_known[i] = 0;
      if (value != Cell::occupied) continue;
      to_wall[i] = 0;
      walls[i].x += static_cast<float>((column + 0.5) * scale + kMargin);
      walls[i].y += static_cast<float>(y);
      ++walls[i].count;
    }
  }
  for (const WallSum& wall : walls) {
    if (wall.count > 0)
      map.walls.push_back(
          {static_cast<double>(wall.x) / wall.count, static_cast<double>(wall.y) / wall.count});
  }

  chamfer_distance(to_wall, map.width, map.height);
  chamfer_distance(to_known, map.width, map.height);
  map.distance.resize(size);
  std::array<std::size_t, kDistanceBins> counts{};
  std::size_t seen = 0;
  for (std::size_t i = 0; i < size; ++i) {
    if (to_known[i] > kSeenReach * kChamferStep) {
      map.distance[i] = kUnseen;
      continue;
    }
    const int bin = std::min((to_wall[i] + kChamferStep / 2) / kChamferStep, kDistanceBins - 1);
    map.distance[i] = static_cast<std::uint8_t>(bin);
    ++counts[bin];
    ++seen;
  }
  for (int bin = 0; bin < kDistanceBins; ++bin) {  // one more in every bin: no background is ever 0
    map.background[bin] = static_cast<double>(counts[bin] + 1) / static_cast<double>(seen + kDistanceBins);
  }
  return map;
}

}  // namespace gridmerge
