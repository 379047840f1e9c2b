// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "report/interchange.hpp"
#include "report/interchange_support.hpp"

namespace gridmerge {

using namespace internal;
using namespace test;
namespace {

RC_GTEST_PROP(Outlines, HoldEveryKnownCellAndTouchTheirCorners, ()) {
  const OccupancyGrid map = any_map();
  const std::vector<Point2> outline = known_outline(map);
  RC_ASSERT(outline.size() >= 4u);
  RC_ASSERT(twice_area(outline) > 0.0);
  std::vector<Point2> corners;
  for (int row = 0; row < map.height; ++row) {
    for (int column = 0; column < map.width; ++column) {
      if (map.cells[static_cast<std::size_t>(row * map.width + column)] == Cell::unknown) continue;
      for (const double dx : {0.0, 1.0}) {
        for (const double dy : {0.0, 1.0})
          corners.push_back(map.origin * Point2{(column + dx) * map.resolution, (row + dy) * map.resolution});
      }
    }
  }
  for (const Point2& corner : corners) RC_ASSERT(outside(outline, corner) < 1e-9);
  for (const Point2& point : outline) {
    RC_ASSERT(std::any_of(corners.begin(), corners.end(), [&](const Point2& corner) {
      return std::hypot(corner.x - point.x, corner.y - point.y) < 1e-9;
    }));
  }
}

RC_GTEST_PROP(Outlines, AreThoseOfEveryTriple, ()) {
  // A point is a corner if it lies in no triangle of others: brute force.
  std::vector<Point2> points(*rc::gen::inRange<std::size_t>(3, 9));
  for (Point2& point : points) point = {real_between(-5, 5), real_between(-5, 5)};
  const std::vector<Point2> hull = convex_hull(points);
  RC_PRE(hull.size() >= 3u);
  for (const Point2& point : points) {
    bool is_inside = false;
    for (const Point2& a : points)
      for (const Point2& b : points)
        for (const Point2& c : points) {
          if (a == point || b == point || c == point || twice_area({a, b, c}) <= 0.0) continue;
          is_inside = is_inside || outside({a, b, c}, point) < 0.0;
        }
    const bool is_corner = std::find(hull.begin(), hull.end(), point) != hull.end();
    RC_ASSERT(!(is_inside && is_corner));
    RC_ASSERT(outside(hull, point) < 1e-12);
  }
}

}  // namespace
}  // namespace gridmerge
