// SPDX-License-Identifier: Apache-2.0
#include "similarity/likelihood_field.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <utility>

#include "grid/for_each_equal.hpp"
#include "grid/multiversion.hpp"
#include "gridmerge/grid/execution.hpp"
#include "similarity/chamfer.hpp"

namespace gridmerge::internal {

namespace {

constexpr int kMargin = 4;     // cells around the known area, so that distances reach beyond its rim
constexpr int kSeenReach = 2;  // cells beyond a known one that still count as seen

constexpr int kFacingReach = 3;  // cells around a wall whose free cells decide which way it faces
/// The free side must have this share of half the window more than the other.
constexpr double kFacingBalance = 0.25;
/// A balanced wall has an axis if its cells spread so much more along it than across it, and each side has
/// this share of free cells: a pillar has no axis, nor has the inside of a thick wall.
constexpr double kAxisElongation = 4.0;
constexpr double kAxisFree = 0.3;

/// A thing that stands alone: at least so many wall cells that touch each other and no other wall, no farther
/// apart than this.
constexpr std::size_t kMinThing = 3;
constexpr double kLargestThing = 2.5;  // [m]

/// Marks what lies within kSeenReach of a known cell by the chamfer distance: two cells along a row or a
/// column, or one diagonally. The border of two cells must not be known.
GRIDMERGE_MULTIVERSION
void widen(const std::uint8_t* known, int width, int height, std::uint8_t* seen) {
  static_assert(kSeenReach == 2 && kChamferDiagonal <= 2 * kChamferStep &&
                kChamferDiagonal + kChamferStep > 2 * kChamferStep);
  for (int y = 2; y + 2 < height; ++y) {
    const std::size_t line = static_cast<std::size_t>(y) * width;
    const std::uint8_t *const row = known + line, *const below = row - width, *const above = row + width;
    const std::uint8_t *const far_below = below - width, *const far_above = above + width;
    std::uint8_t* const out = seen + line;
    for (int x = 2; x + 2 < width; ++x) {
      const int along =
          row[x - 2] | row[x - 1] | row[x] | row[x + 1] | row[x + 2] | far_below[x] | far_above[x];
      const int beside = below[x - 1] | below[x] | below[x + 1] | above[x - 1] | above[x] | above[x + 1];
      out[x] = static_cast<std::uint8_t>(along | beside);
    }
  }
}

/// Sums over boxes of a 0/1 image in constant time.
class BoxSums {
 public:
  BoxSums(const std::vector<std::uint8_t>& image, int width, int height)
      : stride_(width + 1), sums_(static_cast<std::size_t>(width + 1) * (height + 1), 0) {
    for (int y = 0; y < height; ++y) {
      throw_if_cancelled();
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

/// Of the occupied cells of the grid that share a cell.
struct CellSum {
  float x = 0.0F;
  float y = 0.0F;
  int count = 0;
};

/// The axis of the wall at (x, y), of which neither side has more free cells; kNoDirection if it has none.
std::uint8_t find_axis(const std::vector<std::uint8_t>& is_wall, const std::vector<std::uint8_t>& is_free,
                       int width, int x, int y) {
  constexpr int kReach = kFacingReach;
  double count = 0.0, sx = 0.0, sy = 0.0, xx = 0.0, yy = 0.0, xy = 0.0;
  for (int dy = -kReach; dy <= kReach; ++dy) {
    for (int dx = -kReach; dx <= kReach; ++dx) {
      if (is_wall[static_cast<std::size_t>(y + dy) * width + (x + dx)] == 0) continue;
      count += 1.0;
      sx += dx;
      sy += dy;
      xx += dx * dx;
      yy += dy * dy;
      xy += dx * dy;
    }
  }
  xx -= sx * sx / count;
  yy -= sy * sy / count;
  xy -= sx * sy / count;
  const double middle = 0.5 * (xx + yy), spread = std::hypot(0.5 * (xx - yy), xy);
  // One cell across: a wall of one cell is as thick as a cell, not as thick as its centres' line.
  if (middle + spread < kAxisElongation * (middle - spread + count / 12.0)) return kNoDirection;
  const double across = 0.5 * std::atan2(2.0 * xy, xx - yy) + 0.5 * std::numbers::pi;
  const double nx = std::cos(across), ny = std::sin(across);
  int free[2] = {0, 0}, cells[2] = {0, 0};
  for (int dy = -kReach; dy <= kReach; ++dy) {
    for (int dx = -kReach; dx <= kReach; ++dx) {
      const double off = nx * dx + ny * dy;
      if (std::abs(off) < 1.0) continue;
      ++cells[off > 0.0];
      free[off > 0.0] += is_free[static_cast<std::size_t>(y + dy) * width + (x + dx)];
    }
  }
  if (free[0] < kAxisFree * cells[0] || free[1] < kAxisFree * cells[1]) return kNoDirection;
  const double parts = (across / (2.0 * std::numbers::pi) + 1.0) * kDirections;
  return static_cast<std::uint8_t>(kDirections + static_cast<int>(std::lround(parts)) % kAxes);
}

/// The direction from the wall at (x, y) to where more free cells are, kNoDirection where the sides are
/// balanced.
std::uint8_t find_side(const BoxSums& free_cells, int x, int y) {
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

/// Marks the walls of small things. `at` has the index of each cell's wall, or -1.
void mark_things(LikelihoodField& map, const std::vector<int>& at) {
  const double largest = kLargestThing / map.cell;
  std::vector<std::uint8_t> visited(map.walls.size(), 0);
  std::vector<int> thing;
  for (int first = 0; first < std::ssize(map.walls); ++first) {
    if (visited[first] != 0) continue;
    thing.assign(1, first);
    visited[first] = 1;
    double left = 1e9, right = -1e9, bottom = 1e9, top = -1e9;
    for (std::size_t i = 0; i < thing.size(); ++i) {
      const Point2& p = map.walls[thing[i]].position;
      left = std::min(left, p.x);
      right = std::max(right, p.x);
      bottom = std::min(bottom, p.y);
      top = std::max(top, p.y);
      const int x = static_cast<int>(p.x), y = static_cast<int>(p.y);
      for (int dy = -1; dy <= 1; ++dy) {
        for (int dx = -1; dx <= 1; ++dx) {
          const int other = at[static_cast<std::size_t>(y + dy) * map.width + (x + dx)];
          if (other < 0 || visited[other] != 0) continue;
          visited[other] = 1;
          thing.push_back(other);
        }
      }
    }
    if (thing.size() < kMinThing || std::hypot(right - left, top - bottom) > largest) continue;
    for (const int wall : thing) map.walls[wall].stands_alone = true;
  }
}

/// A grid and where its cells lie among those of a field.
class DrawnGrid {
 public:
  DrawnGrid(const OccupancyGrid& grid, const LikelihoodField& map)
      : grid_(grid), scale_(grid.resolution / map.cell), width_(map.width), cell_x_(grid.width) {
    for (int column = 0; column < grid.width; ++column)
      cell_x_[column] = static_cast<int>((column + 0.5) * scale_) + kMargin;
  }

  const OccupancyGrid& grid() const { return grid_; }
  int cell_x(std::size_t column) const { return cell_x_[column]; }
  std::size_t line_of(int row) const {
    return static_cast<std::size_t>((row + 0.5) * scale_ + kMargin) * width_;
  }

  /// Where in the field the middle of a grid's row or column lies [cells].
  float middle(double row_or_column) const {
    return static_cast<float>((row_or_column + 0.5) * scale_ + kMargin);
  }

  /// Calls back with the columns of a row's occupied cells.
  template <typename Visit>
  void for_each_occupied(int row, Visit visit) const {
    for_each_equal(grid_.cells.data() + grid_.index(0, row), static_cast<std::size_t>(grid_.width),
                   Cell::occupied, visit);
  }

 private:
  const OccupancyGrid& grid_;
  double scale_;
  int width_;
  std::vector<int> cell_x_;  // by column
};

/// What a field's cells hold, 0 or 1 each.
struct CellMarks {
  std::vector<std::uint8_t> is_known, is_wall, is_free;
};

CellMarks mark_cells(const DrawnGrid& drawn, std::size_t size) {
  const OccupancyGrid& grid = drawn.grid();
  std::vector<std::uint8_t> is_known(size, 0), is_wall(size, 0);
  for (int row = 0; row < grid.height; ++row) {
    throw_if_cancelled();
    const std::size_t line = drawn.line_of(row);
    const Cell* const cells = grid.cells.data() + grid.index(0, row);
    for (int column = 0; column < grid.width; ++column)  // no branch: it cannot be foreseen
      is_known[line + drawn.cell_x(column)] |= static_cast<std::uint8_t>(cells[column] != Cell::unknown);
    drawn.for_each_occupied(row, [&](std::size_t column) { is_wall[line + drawn.cell_x(column)] = 1; });
  }
  std::vector<std::uint8_t> is_free = is_known;
  for (std::size_t i = 0; i < size; ++i)
    is_free[i] &= static_cast<std::uint8_t>(is_wall[i] ^ 1);  // a wall hides the free cells in its cell
  return {std::move(is_known), std::move(is_wall), std::move(is_free)};
}

/// The walls in the order of their cells, with the way they face. `wall_at` becomes the index of each cell's
/// wall, and `to_wall`, which must be kFarDistance, the facing where there is one.
void find_walls(const CellMarks& marks, LikelihoodField& map, std::vector<int>& wall_at,
                std::vector<LabelledDistance>& to_wall) {
  const BoxSums free_cells(marks.is_free, map.width, map.height);
  for (int y = 0; y < map.height; ++y) {
    throw_if_cancelled();
    const std::size_t line = static_cast<std::size_t>(y) * map.width;
    for_each_equal(marks.is_wall.data() + line, static_cast<std::size_t>(map.width), std::uint8_t{1},
                   [&](std::size_t x) {
                     std::uint8_t facing = find_side(free_cells, static_cast<int>(x), y);
                     if (facing == kNoDirection)
                       facing = find_axis(marks.is_wall, marks.is_free, map.width, static_cast<int>(x), y);
                     to_wall[line + x] = facing;
                     wall_at[line + x] = static_cast<int>(map.walls.size());
                     map.walls.push_back({{}, facing});
                   });
  }
}

/// Puts each wall at the centroid of the occupied cells inside its cell.
void place_walls(const DrawnGrid& drawn, const std::vector<int>& wall_at, LikelihoodField& map) {
  std::vector<CellSum> sums(map.walls.size());
  for (int row = 0; row < drawn.grid().height; ++row) {
    throw_if_cancelled();
    const std::size_t line = drawn.line_of(row);
    const float y = drawn.middle(row);
    drawn.for_each_occupied(row, [&](std::size_t column) {
      CellSum& sum = sums[wall_at[line + drawn.cell_x(column)]];
      sum.x += drawn.middle(static_cast<double>(column));
      sum.y += y;
      ++sum.count;
    });
  }
  for (std::size_t i = 0; i < sums.size(); ++i) {
    const CellSum& sum = sums[i];
    map.walls[i].position = {static_cast<double>(sum.x) / sum.count, static_cast<double>(sum.y) / sum.count};
  }
}

/// What the map says of each place that it has seen, and how often each distance is. `to_wall` is that of
/// chamfer_distance().
void fill_places(const std::vector<std::uint8_t>& is_known, const std::vector<LabelledDistance>& to_wall,
                 LikelihoodField& map) {
  const std::size_t size = to_wall.size();
  std::vector<std::uint8_t> is_seen(size, 0);
  widen(is_known.data(), map.width, map.height, is_seen.data());
  map.places.resize(size);
  std::array<std::size_t, kDistanceBins> counts{};
  std::size_t seen = 0;
  for (std::size_t i = 0; i < size; ++i) {
    if (is_seen[i] == 0) continue;  // stays unseen
    const int cells = static_cast<int>(to_wall[i] / kDistanceLabels + kChamferStep / 2) / kChamferStep;
    const int bin = std::min(cells, kDistanceBins - 1);
    map.places[i] = {static_cast<std::uint8_t>(bin), static_cast<std::uint8_t>(to_wall[i] % kDistanceLabels)};
    ++counts[bin];
    ++seen;
  }
  for (int bin = 0; bin < kDistanceBins; ++bin) {  // one more in every bin: no background is ever 0
    map.background[bin] = static_cast<double>(counts[bin] + 1) / static_cast<double>(seen + kDistanceBins);
  }
}

}  // namespace

int steps_of_turn(double theta) {
  const double steps = (theta / (2.0 * std::numbers::pi) + 1.0) * kDirections;
  // The next lower whole number: std::floor() and std::lround() are calls on many a machine.
  const int whole = static_cast<int>(steps) - (steps < 0.0 ? 1 : 0);
  static_assert((kDirections & (kDirections - 1)) == 0);  // so that the bits are the remainder, also below 0
  return (whole + (steps - whole >= 0.5 ? 1 : 0)) & (kDirections - 1);
}

LikelihoodField make_likelihood_field(const OccupancyGrid& grid, double cell) {
  const double scale = grid.resolution / cell;
  LikelihoodField map;
  map.cell = cell;
  map.width = static_cast<int>(std::ceil(grid.width * scale)) + 2 * kMargin;
  map.height = static_cast<int>(std::ceil(grid.height * scale)) + 2 * kMargin;
  const Point2 corner = grid.origin * Point2{-kMargin * cell, -kMargin * cell};
  map.T_map_grid = {corner.x, corner.y, grid.origin.theta};

  const std::size_t size = static_cast<std::size_t>(map.width) * map.height;
  const DrawnGrid drawn(grid, map);
  const CellMarks marks = mark_cells(drawn, size);
  std::vector<LabelledDistance> to_wall(size, kFarDistance);
  std::vector<int> wall_at(size, -1);
  find_walls(marks, map, wall_at, to_wall);
  place_walls(drawn, wall_at, map);
  mark_things(map, wall_at);
  chamfer_distance(to_wall, map.width, map.height);
  fill_places(marks.is_known, to_wall, map);
  return map;
}

}  // namespace gridmerge::internal
