// SPDX-License-Identifier: Apache-2.0
#include "gridmerge/similarity/wall_map.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "gridmerge/grid/resample.hpp"

namespace gridmerge {

namespace {

constexpr int kMargin = 4;       // cells around the known area, so that distances reach beyond its rim
constexpr int kSeenReach = 2;    // cells beyond a known one that still count as seen
constexpr int kChamferStep = 3;  // distance units of one cell
constexpr int kChamferDiagonal = 4;
constexpr std::uint16_t kFar = 60000;

constexpr int kFacingReach = 3;  // cells around a wall whose free cells decide which way it faces
constexpr double kFacingBalance =
    0.25;  // the free side must have this share of the window more than the other

/// In place: 0 where the input is 0, elsewhere the chamfer distance to the nearest 0. The border must be
/// kFar. `labels`, where given, spread from the zeros to the places nearest to them.
void chamfer_distance(std::vector<std::uint16_t>& distance, int width, int height,
                      std::vector<std::uint8_t>* labels = nullptr) {
  const auto relax = [&](std::size_t i, std::ptrdiff_t side, std::ptrdiff_t row) {
    std::size_t nearest = i;
    int least = distance[i];
    const auto offer = [&](std::size_t from, int step) {
      if (distance[from] + step < least) {
        least = distance[from] + step;
        nearest = from;
      }
    };
    offer(i + side, kChamferStep);
    offer(i + row, kChamferStep);
    offer(i + row - 1, kChamferDiagonal);
    offer(i + row + 1, kChamferDiagonal);
    distance[i] = static_cast<std::uint16_t>(least);
    if (labels != nullptr) (*labels)[i] = (*labels)[nearest];
  };
  for (int y = 1; y < height; ++y) {
    for (int x = 1; x + 1 < width; ++x) relax(static_cast<std::size_t>(y) * width + x, -1, -width);
  }
  for (int y = height - 2; y >= 0; --y) {
    for (int x = width - 2; x > 0; --x) relax(static_cast<std::size_t>(y) * width + x, 1, width);
  }
}

/// Sums over boxes of a 0/1 image in constant time.
class BoxSums {
 public:
  BoxSums(const std::vector<std::uint8_t>& image, int width, int height)
      : stride_(width + 1), sums_(static_cast<std::size_t>(width + 1) * (height + 1), 0) {
    for (int y = 0; y < height; ++y) {
      int row = 0;
      for (int x = 0; x < width; ++x) {
        row += image[static_cast<std::size_t>(y) * width + x];
        at(x + 1, y + 1) = at(x + 1, y) + row;
      }
    }
  }

  /// Over columns [left, right) and rows [bottom, top).
  int operator()(int left, int bottom, int right, int top) const {
    return at(right, top) - at(left, top) - at(right, bottom) + at(left, bottom);
  }

 private:
  int& at(int x, int y) { return sums_[static_cast<std::size_t>(y) * stride_ + x]; }
  int at(int x, int y) const { return sums_[static_cast<std::size_t>(y) * stride_ + x]; }

  int stride_;
  std::vector<int> sums_;
};

/// The direction from the wall at (x, y) to where more free cells are, kNoDirection where the sides are
/// balanced.
std::uint8_t find_facing(const BoxSums& free_cells, int x, int y) {
  constexpr int kReach = kFacingReach;
  const int right = free_cells(x + 1, y - kReach, x + kReach + 1, y + kReach + 1);
  const int left = free_cells(x - kReach, y - kReach, x, y + kReach + 1);
  const int above = free_cells(x - kReach, y + 1, x + kReach + 1, y + kReach + 1);
  const int below = free_cells(x - kReach, y - kReach, x + kReach + 1, y);
  const double dx = right - left;
  const double dy = above - below;
  constexpr double kHalfWindow = kReach * (2 * kReach + 1);
  if (std::hypot(dx, dy) < kFacingBalance * kHalfWindow) return kNoDirection;
  const double turns = std::atan2(dy, dx) / (2.0 * std::numbers::pi);
  return static_cast<std::uint8_t>(static_cast<int>(std::lround((turns + 1.0) * kDirections)) % kDirections);
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
  std::vector<std::uint8_t> is_free(size, 0);
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
      is_free[i] = 1;
      if (value != Cell::occupied) continue;
      to_wall[i] = 0;
      walls[i].x += static_cast<float>((column + 0.5) * scale + kMargin);
      walls[i].y += static_cast<float>(y);
      ++walls[i].count;
    }
  }
  for (std::size_t i = 0; i < size; ++i) {
    if (walls[i].count > 0) is_free[i] = 0;  // a wall hides the free cells that share its cell
  }

  const BoxSums free_cells(is_free, map.width, map.height);
  std::vector<std::uint8_t> facing(size, kNoDirection);
  for (int y = 0; y < map.height; ++y) {
    for (int x = 0; x < map.width; ++x) {
      const std::size_t i = static_cast<std::size_t>(y) * map.width + x;
      const WallSum& wall = walls[i];
      if (wall.count == 0) continue;
      facing[i] = find_facing(free_cells, x, y);
      map.walls.push_back(
          {{static_cast<double>(wall.x) / wall.count, static_cast<double>(wall.y) / wall.count}, facing[i]});
    }
  }

  chamfer_distance(to_wall, map.width, map.height, &facing);
  chamfer_distance(to_known, map.width, map.height);
  map.places.resize(size);
  std::array<std::size_t, kDistanceBins> counts{};
  std::size_t seen = 0;
  for (std::size_t i = 0; i < size; ++i) {
    if (to_known[i] > kSeenReach * kChamferStep) continue;  // stays unseen
    const int bin = std::min((to_wall[i] + kChamferStep / 2) / kChamferStep, kDistanceBins - 1);
    map.places[i] = {static_cast<std::uint8_t>(bin), facing[i]};
    ++counts[bin];
    ++seen;
  }
  for (int bin = 0; bin < kDistanceBins; ++bin) {  // one more in every bin: no background is ever 0
    map.background[bin] = static_cast<double>(counts[bin] + 1) / static_cast<double>(seen + kDistanceBins);
  }
  return map;
}

}  // namespace gridmerge
