// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "simulate/building_parts.hpp"

namespace gridmerge::internal {

namespace {

constexpr double kNarrowest = 1.2;  // ways [m]
constexpr double kWidest = 2.5;

/// Where walls can stand along one side: lines that part it into ways of nearly one width, or of different
/// ones.
std::vector<double> place_lines(Random& random, double side, double way, bool even) {
  const int least = static_cast<int>(std::ceil(side / kWidest));
  const int most = static_cast<int>(std::floor(side / kNarrowest));
  const int ways = std::clamp(static_cast<int>(std::lround(side / way)), least, most);
  const double each = side / ways;
  const double shift = even ? 0.0 : 0.5 * std::min(each - kNarrowest, kWidest - each);
  std::vector<double> lines{0.0};
  for (int i = 1; i < ways; ++i) lines.push_back(i * each + random.uniform(-shift, shift));
  lines.push_back(side);
  return lines;
}

class Maze {
 public:
  Maze(Random& random, int columns, int rows)
      : columns_(columns),
        rows_(rows),
        right_(static_cast<std::size_t>(columns) * rows, 1),
        above_(right_.size(), 1) {
    carve_tree(random);
    open_loops(random);
  }

  bool wall_right(int column, int row) const { return right_[index(column, row)] != 0; }
  bool wall_above(int column, int row) const { return above_[index(column, row)] != 0; }

 private:
  struct Step {
    int column, row, dx, dy;
  };

  std::size_t index(int column, int row) const { return static_cast<std::size_t>(row) * columns_ + column; }

  void remove_wall(const Step& step) {
    const int column = std::min(step.column, step.column + step.dx);
    const int row = std::min(step.row, step.row + step.dy);
    (step.dx != 0 ? right_ : above_)[index(column, row)] = 0;
  }

  /// Every cell is reached on one way: goes on from the newest cell, and sometimes from any other.
  void carve_tree(Random& random) {
    std::vector<std::uint8_t> visited(right_.size(), 0);
    const double wander = random.uniform(0.0, 0.35);
    const int column = random.pick(0, columns_ - 1), row = random.pick(0, rows_ - 1);
    std::vector<std::size_t> open{index(column, row)};
    visited[open.front()] = 1;
    while (!open.empty()) {
      const std::size_t from =
          random.chance(wander) ? static_cast<std::size_t>(random.pick(0, static_cast<int>(open.size()) - 1))
                                : open.size() - 1;
      const std::optional<Step> step = any_step(random, open[from], visited);
      if (!step) {
        open.erase(open.begin() + static_cast<std::ptrdiff_t>(from));
        continue;
      }
      remove_wall(*step);
      open.push_back(index(step->column + step->dx, step->row + step->dy));
      visited[open.back()] = 1;
    }
  }

  std::optional<Step> any_step(Random& random, std::size_t cell,
                               const std::vector<std::uint8_t>& visited) const {
    const int column = static_cast<int>(cell) % columns_, row = static_cast<int>(cell) / columns_;
    std::vector<Step> steps;
    for (const auto& [dx, dy] : {std::pair{1, 0}, std::pair{-1, 0}, std::pair{0, 1}, std::pair{0, -1}}) {
      const int x = column + dx, y = row + dy;
      if (x < 0 || y < 0 || x >= columns_ || y >= rows_ || visited[index(x, y)] != 0) continue;
      steps.push_back({column, row, dx, dy});
    }
    if (steps.empty()) return std::nullopt;
    return steps[static_cast<std::size_t>(random.pick(0, static_cast<int>(steps.size()) - 1))];
  }

  void open_loops(Random& random) {
    const double share = random.uniform(0.04, 0.15);
    for (int row = 0; row < rows_; ++row) {
      for (int column = 0; column < columns_; ++column) {
        if (column + 1 < columns_ && random.chance(share)) remove_wall({column, row, 1, 0});
        if (row + 1 < rows_ && random.chance(share)) remove_wall({column, row, 0, 1});
      }
    }
  }

  int columns_;
  int rows_;
  std::vector<std::uint8_t> right_;  // of a cell, whether there is a wall
  std::vector<std::uint8_t> above_;
};

}  // namespace

void draw_maze(Draughtsman& pen, Random& random, double width, double height) {
  const double way = random.uniform(kNarrowest + 0.1, kWidest - 0.1);
  const bool even = random.chance(0.5);
  const std::vector<double> xs = place_lines(random, width, way, even);
  const std::vector<double> ys = place_lines(random, height, way, even);
  const int columns = static_cast<int>(xs.size()) - 1, rows = static_cast<int>(ys.size()) - 1;
  const Maze maze(random, columns, rows);
  // Walls in a row are one edge, so that no beam slips between two.
  for (int row = 0; row <= rows; ++row) {
    for (int column = 0, from = -1; column <= columns; ++column) {
      const bool wall = column < columns && (row == 0 || maze.wall_above(column, row - 1));
      if (wall && from < 0) from = column;
      if (wall || from < 0) continue;
      const double y = ys[static_cast<std::size_t>(row)];
      pen.edges.push_back(
          {{xs[static_cast<std::size_t>(from)], y}, {xs[static_cast<std::size_t>(column)], y}, 1.0});
      from = -1;
    }
  }
  for (int column = 0; column <= columns; ++column) {
    for (int row = 0, from = -1; row <= rows; ++row) {
      const bool wall = row < rows && (column == 0 || maze.wall_right(column - 1, row));
      if (wall && from < 0) from = row;
      if (wall || from < 0) continue;
      const double x = xs[static_cast<std::size_t>(column)];
      pen.edges.push_back(
          {{x, ys[static_cast<std::size_t>(from)]}, {x, ys[static_cast<std::size_t>(row)]}, 1.0});
      from = -1;
    }
  }
}

}  // namespace gridmerge::internal
