// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "simulate/draughtsman.hpp"

namespace gridmerge::internal {

/// Where a robot can stand: a raster of the inside of a building, without what is nearer to an edge than the
/// robot's radius. Of several rooms that no way connects it keeps the largest.
class FloorPlan {
 public:
  static constexpr double kCell = 0.1;  // [m]

  /// O(cells + edges * cells around each).
  FloorPlan(const std::vector<Edge>& edges, double robot_radius);

  int cells() const { return width_ * height_; }
  bool is_free(int cell) const { return free_[static_cast<std::size_t>(cell)] != 0; }
  int count_free() const { return static_cast<int>(free_cells_.size()); }
  const std::vector<int>& free_cells() const { return free_cells_; }
  Point2 centre(int cell) const;
  /// The cell that holds `p`, or -1.
  int cell_at(Point2 p) const;
  /// The free cell nearest to `p`, or -1 where there is none within `reach` metres.
  int free_cell_near(Point2 p, double reach) const;

  int width() const { return width_; }

 private:
  void keep_largest_inside();

  Point2 corner_;
  int width_ = 0;
  int height_ = 0;
  std::vector<std::uint8_t> free_;
  std::vector<int> free_cells_;
};

/// Shortest ways over a floor plan, by steps to the eight neighbours (Dijkstra's algorithm, with Dial's
/// buckets). Keeps its memory from search to search.
class PathSearch {
 public:
  explicit PathSearch(const FloorPlan& plan);

  /// Visits free cells in the order of their distance from `from` until `stop` says true of one. Returns that
  /// cell, or -1 when none is left within `reach` metres. `stop` gets the cell and its distance [m]. O(cells
  /// visited).
  int search(int from, double reach, const std::function<bool(int, double)>& stop);

  /// The way of the last search to a cell that it visited, both ends included.
  std::vector<Point2> path_to(int cell) const;

 private:
  const FloorPlan& plan_;
  std::vector<std::uint32_t> visit_;  // the search that a cell's numbers below belong to
  std::vector<int> distance_;         // in fifths of a cell
  std::vector<int> parent_;
  std::uint32_t searches_ = 0;
};

}  // namespace gridmerge::internal
