// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <optional>

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

std::vector<Point2> known_outline(const OccupancyGrid& grid) {
  std::vector<Point2> corners;  // in cells
  for (int row = 0; row < grid.height; ++row) {
    const std::optional<Span> known = known_in(grid, row);
    if (!known) continue;
    for (const int y : {row, row + 1}) {
      corners.push_back({static_cast<double>(known->first), static_cast<double>(y)});
      corners.push_back({static_cast<double>(known->last + 1), static_cast<double>(y)});
    }
  }
  return in_map_frame(convex_hull(std::move(corners)), grid);
}

std::vector<Point2> known_corners(const OccupancyGrid& grid) {
  std::optional<int> bottom;
  int top = 0, left = grid.width, right = 0;
  for (int row = 0; row < grid.height; ++row) {
    const std::optional<Span> known = known_in(grid, row);
    if (!known) continue;
    if (!bottom) bottom = row;
    top = row + 1;
    left = std::min(left, known->first);
    right = std::max(right, known->last + 1);
  }
  if (!bottom) return {};
  const auto l = static_cast<double>(left), r = static_cast<double>(right), t = static_cast<double>(top);
  const auto b = static_cast<double>(*bottom);
  return in_map_frame({{l, b}, {r, b}, {r, t}, {l, t}}, grid);
}

}  // namespace gridmerge::internal
