// SPDX-License-Identifier: Apache-2.0
#include "simulate/draughtsman.hpp"

#include <cmath>
#include <cstddef>

#include "gridmerge/grid/execution.hpp"

namespace gridmerge::internal {

void Draughtsman::polygon(const std::vector<Point2>& corners, double echo) {
  throw_if_cancelled();  // whatever is drawn is drawn of these
  for (std::size_t i = 0; i < corners.size(); ++i) {
    edges.push_back({corners[i], corners[(i + 1) % corners.size()], echo});
  }
}

void Draughtsman::box(Point2 centre, double length, double width, Point2 direction, double echo) {
  const double norm = std::sqrt(direction.x * direction.x + direction.y * direction.y);
  const Point2 u{direction.x / norm * length / 2.0, direction.y / norm * length / 2.0};
  const Point2 v{-direction.y / norm * width / 2.0, direction.x / norm * width / 2.0};
  polygon({{centre.x - u.x - v.x, centre.y - u.y - v.y},
           {centre.x + u.x - v.x, centre.y + u.y - v.y},
           {centre.x + u.x + v.x, centre.y + u.y + v.y},
           {centre.x - u.x + v.x, centre.y - u.y + v.y}},
          echo);
}

void Draughtsman::wall(Point2 from, Point2 to, const std::vector<Door>& doors, double echo) {
  constexpr double kThickness = 0.16;
  const Point2 along{to.x - from.x, to.y - from.y};
  const double length = std::sqrt(along.x * along.x + along.y * along.y);
  const Point2 unit{along.x / length, along.y / length};
  const auto piece = [&](double start, double end) {
    const double middle = (start + end) / 2.0;
    box({from.x + unit.x * middle, from.y + unit.y * middle}, end - start, kThickness, unit, echo);
  };
  double start = -kThickness / 2.0;  // walls reach into one another at corners, so that none gapes
  for (const Door& door : doors) {
    piece(start, door.at);
    start = door.at + door.width;
    if (door.leaf != 0) {
      // A leaf about 70 degrees open.
      const Point2 leaf{0.34 * unit.x - 0.94 * door.leaf * unit.y, 0.34 * unit.y + 0.94 * door.leaf * unit.x};
      const double middle = door.width * 0.5;
      box({from.x + unit.x * door.at + leaf.x * middle, from.y + unit.y * door.at + leaf.y * middle},
          door.width, 0.04, leaf);
    }
  }
  piece(start, length + kThickness / 2.0);
}

void Draughtsman::window_front(Point2 from, Point2 to) {
  const Point2 along{to.x - from.x, to.y - from.y};
  const double length = std::sqrt(along.x * along.x + along.y * along.y);
  const int pieces = 2 * static_cast<int>(length / 3.0) + 1;  // begins and ends with masonry
  const auto at = [&](int i) { return Point2{from.x + along.x * i / pieces, from.y + along.y * i / pieces}; };
  for (int i = 0; i < pieces; ++i) wall(at(i), at(i + 1), {}, i % 2 == 0 ? 1.0 : kGlass);
}

void Draughtsman::pillar(Point2 centre, double radius) {
  constexpr double kDiagonal = 0.7071067811865476;
  std::vector<Point2> corners;
  for (const Point2& c : {Point2{1.0, 0.0}, Point2{kDiagonal, kDiagonal}, Point2{0.0, 1.0},
                          Point2{-kDiagonal, kDiagonal}, Point2{-1.0, 0.0}, Point2{-kDiagonal, -kDiagonal},
                          Point2{0.0, -1.0}, Point2{kDiagonal, -kDiagonal}}) {
    corners.push_back({centre.x + radius * c.x, centre.y + radius * c.y});
  }
  polygon(corners);
}

void Draughtsman::table(Point2 centre, double length, double width) {
  for (const double x : {-0.5, 0.5}) {
    for (const double y : {-0.5, 0.5}) {
      box({centre.x + x * (length - 0.1), centre.y + y * (width - 0.1)}, 0.06, 0.06);
    }
  }
}

void Draughtsman::chair(Point2 centre) {
  for (const Point2& foot : {Point2{0.0, 0.22}, Point2{0.2, -0.1}, Point2{-0.2, -0.1}}) {
    box({centre.x + foot.x, centre.y + foot.y}, 0.05, 0.05);
  }
}

void Draughtsman::desk(Point2 centre, int side, int front) {
  table(centre, 1.6, 0.8);
  box({centre.x + side * 0.5, centre.y}, 0.42, 0.58);
  chair({centre.x - side * 0.2, centre.y + front * 0.7});
}

}  // namespace gridmerge::internal
