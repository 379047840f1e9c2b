// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>

#include "grid/cell_box.hpp"
#include "grid/known_rim.hpp"
#include "report/interchange.hpp"

namespace gridmerge::internal {

namespace {

/// Twice the area of the triangle, positive if it turns counter-clockwise.
double turn(const Point2& a, const Point2& b, const Point2& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/// The first and last known column of a row.
struct Span {
  int first = 0;
  int last = 0;
};

std::optional<Span> known_in(const OccupancyGrid& grid, int row) {
  const auto begin = grid.cells.begin() + static_cast<std::ptrdiff_t>(row) * grid.width;
  const auto is_known = [](Cell cell) { return cell != Cell::unknown; };
  const auto first = std::find_if(begin, begin + grid.width, is_known);
  if (first == begin + grid.width) return std::nullopt;
  auto last = begin + grid.width - 1;
  while (!is_known(*last)) --last;
  return Span{static_cast<int>(first - begin), static_cast<int>(last - begin)};
}

/// The smallest upright box that holds all known cells; empty if nothing is known.
CellBox known_box(const OccupancyGrid& grid) {
  CellBox box;
  for (int row = 0; row < grid.height; ++row) {
    if (const std::optional<Span> known = known_in(grid, row))
      box = unite(box, {known->first, row, known->last + 1, row + 1});
  }
  return box;
}

std::vector<Point2> in_map_frame(std::vector<Point2> corners, const OccupancyGrid& grid) {
  for (Point2& corner : corners)
    corner = grid.origin * Point2{corner.x * grid.resolution, corner.y * grid.resolution};
  return corners;
}

}  // namespace

std::vector<Point2> convex_hull(std::vector<Point2> points) {
  const auto before = [](const Point2& a, const Point2& b) { return a.x < b.x || (a.x == b.x && a.y < b.y); };
  std::sort(points.begin(), points.end(), before);
  points.erase(std::unique(points.begin(), points.end()), points.end());
  if (points.size() < 3) return points;
  std::vector<Point2> hull;
  const auto add = [&hull](const Point2& point, std::size_t least) {
    while (hull.size() > least && turn(hull[hull.size() - 2], hull.back(), point) <= 0.0) hull.pop_back();
    hull.push_back(point);
  };
  for (const Point2& point : points) add(point, 1);
  const std::size_t lower = hull.size();
  for (auto point = points.rbegin() + 1; point != points.rend(); ++point) add(*point, lower);
  hull.pop_back();
  return hull;
}

std::vector<Point2> known_outline(const OccupancyGrid& grid, const Member& member) {
  std::vector<Point2> corners;
  if (!member.deformation.is_identity()) {
    for_each_rim_corner(grid, [&](const Point2& corner) { corners.push_back(member.to_component(corner)); });
    return convex_hull(std::move(corners));
  }
  for (int row = 0; row < grid.height; ++row) {  // in cells at first
    const std::optional<Span> known = known_in(grid, row);
    if (!known) continue;
    for (const int y : {row, row + 1}) {
      corners.push_back({static_cast<double>(known->first), static_cast<double>(y)});
      corners.push_back({static_cast<double>(known->last + 1), static_cast<double>(y)});
    }
  }
  corners = in_map_frame(convex_hull(std::move(corners)), grid);
  for (Point2& corner : corners) corner = member.to_component(corner);
  return corners;
}

std::vector<Point2> known_corners(const OccupancyGrid& grid) {
  const CellBox box = known_box(grid);
  if (box.empty()) return {};
  const auto l = static_cast<double>(box.left), r = static_cast<double>(box.right);
  const auto b = static_cast<double>(box.bottom), t = static_cast<double>(box.top);
  return in_map_frame({{l, b}, {r, b}, {r, t}, {l, t}}, grid);
}

std::vector<Point2> spread_cells(const OccupancyGrid& grid) {
  constexpr int kAcross = 4;
  struct Nearest {
    double distance = std::numeric_limits<double>::infinity();  // [cells]
    Point2 centre;
  };
  const CellBox box = known_box(grid);
  std::array<Nearest, kAcross * kAcross> nearest;
  const auto part_of = [](int place, int length) {
    return static_cast<int>(std::int64_t{place} * kAcross / length);
  };
  for (int row = box.bottom; row < box.top; ++row) {
    for (int column = box.left; column < box.right; ++column) {
      if (grid.at(column, row) == Cell::unknown) continue;
      const int across = part_of(column - box.left, box.width()),
                up = part_of(row - box.bottom, box.height());
      const double x = box.left + (across + 0.5) * box.width() / kAcross;
      const double y = box.bottom + (up + 0.5) * box.height() / kAcross;
      Nearest& best = nearest[static_cast<std::size_t>(up * kAcross + across)];
      const double distance = std::hypot(column + 0.5 - x, row + 0.5 - y);
      if (distance < best.distance) best = {distance, grid.cell_centre(column, row)};
    }
  }
  std::vector<Point2> cells;
  for (const Nearest& one : nearest) {
    if (std::isfinite(one.distance)) cells.push_back(one.centre);
  }
  return cells;
}

}  // namespace gridmerge::internal
