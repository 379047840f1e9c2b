// SPDX-License-Identifier: Apache-2.0
#include "match/drawing.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "gridmerge/grid/execution.hpp"
#include "gridmerge/grid/resample.hpp"

namespace gridmerge::internal {

namespace {

/// Of the walls' longer side: half of the widest gap that is closed.
constexpr std::array kClosings{0.0, 0.005, 0.01, 0.02, 0.04};
constexpr double kEnclosed = 0.5;  // share of the walls' bounding box
/// Gray lines, and the soft edges of black ones, are at most so many times two cells wide: [cells] from
/// white.
constexpr std::uint16_t kSoft = 3;
constexpr double kWideGray = 0.01;  // share of the cells that may be gray farther from white
/// So far from black, gray is no soft edge but a line of its own [cells].
constexpr std::uint16_t kSoftEdge = 2;

using Distances = std::vector<std::uint16_t>;
constexpr std::uint16_t kFar = 60000;

/// A raster with a margin around it.
struct Raster {
  int width;
  int height;
  std::size_t index(int x, int y) const { return static_cast<std::size_t>(y) * width + x; }
};

/// In place: the chessboard distance to the nearest zero.
void chessboard_distance(Distances& distance, const Raster& raster) {
  const auto nearer = [&](int x, int y, int from_x, int from_y) {
    if (from_x < 0 || from_y < 0 || from_x >= raster.width || from_y >= raster.height) return;
    std::uint16_t& here = distance[raster.index(x, y)];
    const int there = distance[raster.index(from_x, from_y)] + 1;
    here = static_cast<std::uint16_t>(std::min<int>(here, there));
  };
  for (int y = 0; y < raster.height; ++y) {
    throw_if_cancelled();
    for (int x = 0; x < raster.width; ++x) {
      nearer(x, y, x - 1, y);
      for (int dx = -1; dx <= 1; ++dx) nearer(x, y, x + dx, y - 1);
    }
  }
  for (int y = raster.height - 1; y >= 0; --y) {
    throw_if_cancelled();
    for (int x = raster.width - 1; x >= 0; --x) {
      nearer(x, y, x + 1, y);
      for (int dx = -1; dx <= 1; ++dx) nearer(x, y, x + dx, y + 1);
    }
  }
}

/// Of each cell: the chessboard distance to the nearest of this kind.
Distances distances_to(const OccupancyGrid& grid, Cell kind) {
  Distances distance(grid.cells.size(), kFar);
  for (std::size_t i = 0; i < grid.cells.size(); ++i) {
    if (grid.cells[i] == kind) distance[i] = 0;
  }
  chessboard_distance(distance, {grid.width, grid.height});
  return distance;
}

/// Whether what is neither black nor white is lines and edges: what nobody has seen is wide.
bool has_thin_gray_alone(const OccupancyGrid& grid) {
  const Distances to_white = distances_to(grid, Cell::free);
  std::size_t wide = 0;
  for (std::size_t i = 0; i < grid.cells.size(); ++i) {
    if (grid.cells[i] == Cell::unknown && to_white[i] > kSoft) ++wide;
  }
  return static_cast<double>(wide) <= kWideGray * static_cast<double>(grid.cells.size());
}

/// The lines of a drawing; all else is unknown. Of a drawing with white paper gray lines are lines too.
OccupancyGrid lines_of(const OccupancyGrid& drawing, bool is_on_paper) {
  OccupancyGrid lines = drawing;
  lines.probability.clear();
  const Distances to_black = is_on_paper ? distances_to(drawing, Cell::occupied) : Distances{};
  for (std::size_t i = 0; i < lines.cells.size(); ++i) {
    Cell& cell = lines.cells[i];
    if (is_on_paper && cell == Cell::unknown && to_black[i] > kSoftEdge) {
      cell = Cell::occupied;
    } else if (cell == Cell::free) {
      cell = Cell::unknown;
    }
  }
  return crop_to_known(lines);
}

/// Of the raster's corner: what a disc of `reach` cells reaches from there without touching a wall, zero, and
/// kFar elsewhere.
Distances flooded(const Distances& to_wall, const Raster& raster, int reach) {
  Distances flood(to_wall.size(), kFar);
  std::vector<std::size_t> next{0};
  flood[0] = 0;
  while (!next.empty()) {
    const std::size_t at = next.back();
    next.pop_back();
    const int x = static_cast<int>(at % raster.width), y = static_cast<int>(at / raster.width);
    const auto visit = [&](int to_x, int to_y) {
      if (to_x < 0 || to_y < 0 || to_x >= raster.width || to_y >= raster.height) return;
      const std::size_t to = raster.index(to_x, to_y);
      if (flood[to] == 0 || to_wall[to] <= reach) return;
      flood[to] = 0;
      next.push_back(to);
    };
    visit(x - 1, y);
    visit(x + 1, y);
    visit(x, y - 1);
    visit(x, y + 1);
  }
  return flood;
}

/// `walls` with what they enclose as free, when gaps of up to 2 * reach cells are closed.
OccupancyGrid enclose(const OccupancyGrid& walls, int reach) {
  const int margin = reach + 1;
  const Raster raster{walls.width + 2 * margin, walls.height + 2 * margin};
  Distances to_wall(static_cast<std::size_t>(raster.width) * raster.height, kFar);
  for (int row = 0; row < walls.height; ++row) {
    for (int column = 0; column < walls.width; ++column) {
      if (walls.at(column, row) == Cell::occupied) to_wall[raster.index(column + margin, row + margin)] = 0;
    }
  }
  chessboard_distance(to_wall, raster);
  Distances outside = flooded(to_wall, raster, reach);
  if (reach > 0) chessboard_distance(outside, raster);
  OccupancyGrid enclosed = walls;
  for (int row = 0; row < walls.height; ++row) {
    for (int column = 0; column < walls.width; ++column) {
      const bool is_outside = outside[raster.index(column + margin, row + margin)] <= reach;
      Cell& cell = enclosed.at(column, row);
      if (cell != Cell::occupied) cell = is_outside ? Cell::unknown : Cell::free;
    }
  }
  return enclosed;
}

}  // namespace

bool is_drawing(const OccupancyGrid& grid) {
  const CellCounts counts = count_cells(grid);
  if (counts.free == 0) return counts.occupied > 0;
  // Lines may all be gray. As long as the sheet they are more than a few cells that nobody has seen.
  const std::size_t gray = grid.cells.size() - counts.known();
  if (counts.occupied == 0 && gray < static_cast<std::size_t>(std::max(grid.width, grid.height)))
    return false;
  for (int column = 0; column < grid.width; ++column) {
    if (grid.at(column, 0) != Cell::free || grid.at(column, grid.height - 1) != Cell::free) return false;
  }
  for (int row = 0; row < grid.height; ++row) {
    if (grid.at(0, row) != Cell::free || grid.at(grid.width - 1, row) != Cell::free) return false;
  }
  // Without black, thick gray is walls as well: there are no others.
  return counts.occupied == 0 || has_thin_gray_alone(grid);
}

OccupancyGrid with_enclosed_free(const OccupancyGrid& grid) {
  if (!is_drawing(grid)) return grid;
  const OccupancyGrid walls = lines_of(grid, count_cells(grid).free > 0);
  const double box = static_cast<double>(walls.cells.size());
  const int longer_side = std::max(walls.width, walls.height);
  OccupancyGrid enclosed;
  for (const double closing : kClosings) {
    const int reach = static_cast<int>(std::lround(closing * longer_side));
    // Of a long strip the margin is many times the strip.
    const double margins = 2.0 * (reach + 1);
    if (closing > 0.0 &&
        (reach >= kFar || (walls.width + margins) * (walls.height + margins) > kMaxGridCells))
      break;
    enclosed = enclose(walls, reach);
    if (static_cast<double>(count_cells(enclosed).known()) >= kEnclosed * box) break;
  }
  return enclosed;
}

}  // namespace gridmerge::internal
