// SPDX-License-Identifier: Apache-2.0
#include "simulate/floor_plan.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "gridmerge/grid/execution.hpp"

namespace gridmerge::internal {

namespace {

/// Steps to the neighbours, in fifths of a cell: 7/5 is near enough to the square root of 2.
constexpr int kStraight = 5;
constexpr int kDiagonal = 7;
constexpr int kBuckets = kDiagonal + 1;

struct Neighbour {
  int dx, dy, way;
};
constexpr std::array<Neighbour, 8> kNeighbours{{{1, 0, kStraight},
                                                {-1, 0, kStraight},
                                                {0, 1, kStraight},
                                                {0, -1, kStraight},
                                                {1, 1, kDiagonal},
                                                {1, -1, kDiagonal},
                                                {-1, 1, kDiagonal},
                                                {-1, -1, kDiagonal}}};

}  // namespace

FloorPlan::FloorPlan(const std::vector<Edge>& edges, double robot_radius) {
  if (edges.empty()) return;
  constexpr double kFar = std::numeric_limits<double>::infinity();
  Point2 low{kFar, kFar}, high{-kFar, -kFar};
  for (const Edge& edge : edges) {
    for (const Point2& p : {edge.a, edge.b}) {
      low = {std::min(low.x, p.x), std::min(low.y, p.y)};
      high = {std::max(high.x, p.x), std::max(high.y, p.y)};
    }
  }
  const double margin = robot_radius + 3.0 * kCell;  // a rim that is outside
  corner_ = {low.x - margin, low.y - margin};
  width_ = static_cast<int>((high.x - low.x + 2.0 * margin) / kCell) + 1;
  height_ = static_cast<int>((high.y - low.y + 2.0 * margin) / kCell) + 1;
  free_.assign(static_cast<std::size_t>(width_) * height_, 1);

  for (const Edge& edge : edges) {
    throw_if_cancelled();
    const double length = std::hypot(edge.b.x - edge.a.x, edge.b.y - edge.a.y);
    const int pieces = std::max(1, static_cast<int>(length / (0.5 * kCell)));
    const int reach = static_cast<int>(robot_radius / kCell);
    for (int i = 0; i <= pieces; ++i) {
      const double share = static_cast<double>(i) / pieces;
      const int x = static_cast<int>((edge.a.x + share * (edge.b.x - edge.a.x) - corner_.x) / kCell);
      const int y = static_cast<int>((edge.a.y + share * (edge.b.y - edge.a.y) - corner_.y) / kCell);
      for (int dy = -reach; dy <= reach; ++dy) {
        for (int dx = -reach; dx <= reach; ++dx) {
          if (dx * dx + dy * dy > reach * reach) continue;
          free_[static_cast<std::size_t>(y + dy) * width_ + x + dx] = 0;
        }
      }
    }
  }
  keep_largest_inside();
}

void FloorPlan::keep_largest_inside() {
  // Floods parts one after the other; the first, from the corner, is the outside.
  std::vector<int> part(free_.size(), -1);
  std::vector<int> sizes;
  for (int seed = 0; seed < cells(); ++seed) {
    if (!is_free(seed) || part[static_cast<std::size_t>(seed)] >= 0) continue;
    const int number = static_cast<int>(sizes.size());
    std::vector<int> todo{seed};
    part[static_cast<std::size_t>(seed)] = number;
    int size = 0;
    while (!todo.empty()) {
      const int cell = todo.back();
      todo.pop_back();
      ++size;
      for (int k = 0; k < 4; ++k) {
        const int x = cell % width_ + kNeighbours[static_cast<std::size_t>(k)].dx;
        const int y = cell / width_ + kNeighbours[static_cast<std::size_t>(k)].dy;
        if (x < 0 || y < 0 || x >= width_ || y >= height_) continue;
        const std::size_t next = static_cast<std::size_t>(y) * width_ + x;
        if (free_[next] == 0 || part[next] >= 0) continue;
        part[next] = number;
        todo.push_back(static_cast<int>(next));
      }
    }
    sizes.push_back(size);
  }
  int largest = -1;
  for (int i = 1; i < static_cast<int>(sizes.size()); ++i) {
    if (largest < 0 || sizes[static_cast<std::size_t>(i)] > sizes[static_cast<std::size_t>(largest)])
      largest = i;
  }
  for (int cell = 0; cell < cells(); ++cell) {
    const bool keep = largest > 0 && part[static_cast<std::size_t>(cell)] == largest;
    free_[static_cast<std::size_t>(cell)] = keep ? 1 : 0;
    if (keep) free_cells_.push_back(cell);
  }
}

Point2 FloorPlan::centre(int cell) const {
  const int column = cell % width_;
  const int row = cell / width_;
  return {corner_.x + (column + 0.5) * kCell, corner_.y + (row + 0.5) * kCell};
}

int FloorPlan::cell_at(Point2 p) const {
  const double x = std::floor((p.x - corner_.x) / kCell);
  const double y = std::floor((p.y - corner_.y) / kCell);
  if (!(x >= 0.0 && y >= 0.0 && x < width_ && y < height_)) return -1;
  return static_cast<int>(y) * width_ + static_cast<int>(x);
}

int FloorPlan::free_cell_near(Point2 p, double reach) const {
  int nearest = -1;
  double least = reach;
  for (const int cell : free_cells_) {
    const Point2 at = centre(cell);
    const double distance = std::hypot(at.x - p.x, at.y - p.y);
    if (!(distance <= least)) continue;  // nor of no place at all
    least = distance;
    nearest = cell;
  }
  return nearest;
}

PathSearch::PathSearch(const FloorPlan& plan)
    : plan_(plan),
      visit_(static_cast<std::size_t>(plan.cells()), 0),
      distance_(visit_.size()),
      parent_(visit_.size()) {}

int PathSearch::search(int from, double reach, const std::function<bool(int, double)>& stop) {
  throw_if_cancelled();
  ++searches_;
  constexpr double kUnit = FloorPlan::kCell / kStraight;  // [m]
  std::array<std::vector<int>, kBuckets> buckets;
  const auto offer = [&](int cell, int parent, int distance) {
    const std::size_t i = static_cast<std::size_t>(cell);
    if (visit_[i] == searches_ && distance_[i] <= distance) return;
    visit_[i] = searches_;
    distance_[i] = distance;
    parent_[i] = parent;
    buckets[static_cast<std::size_t>(distance % kBuckets)].push_back(cell);
  };
  offer(from, from, 0);
  int empty = 0;  // buckets in a row
  for (int now = 0; empty < kBuckets && now * kUnit <= reach; ++now) {
    std::vector<int>& bucket = buckets[static_cast<std::size_t>(now % kBuckets)];
    empty = bucket.empty() ? empty + 1 : 0;
    for (const int cell : bucket) {  // none is added to this one: every step is shorter than the circle
      if (distance_[static_cast<std::size_t>(cell)] != now) continue;  // found shorter since
      if (stop(cell, now * kUnit)) return cell;
      const int width = plan_.width();
      for (const Neighbour& neighbour : kNeighbours) {
        const int next = cell + neighbour.dy * width + neighbour.dx;  // free cells have all neighbours
        if (plan_.is_free(next)) offer(next, cell, now + neighbour.way);
      }
    }
    bucket.clear();
  }
  return -1;
}

std::vector<Point2> PathSearch::path_to(int cell) const {
  std::vector<Point2> path{plan_.centre(cell)};
  while (parent_[static_cast<std::size_t>(cell)] != cell) {
    cell = parent_[static_cast<std::size_t>(cell)];
    path.push_back(plan_.centre(cell));
  }
  std::reverse(path.begin(), path.end());
  return path;
}

}  // namespace gridmerge::internal
