// SPDX-License-Identifier: Apache-2.0
#include "simulate/building_parts.hpp"

#include <algorithm>
#include <cmath>

namespace gridmerge::internal {

void place(Draughtsman& pen, const std::vector<Edge>& edges, const SE2& T_building_frame) {
  for (const Edge& edge : edges)
    pen.edges.push_back({T_building_frame * edge.a, T_building_frame * edge.b, edge.echo});
}

void draw_shell(Draughtsman& pen, Random& random, const Room& room) {
  const Point2 corners[] = {
      {room.left, room.bottom}, {room.right, room.bottom}, {room.right, room.top}, {room.left, room.top}};
  for (int i = 0; i < 4; ++i) {
    const Point2 from = corners[i];
    const Point2 to = corners[(i + 1) % 4];
    if (random.chance(0.6)) {
      pen.window_front(from, to);
    } else {
      pen.wall(from, to);
    }
  }
}

void furnish(Draughtsman& pen, Random& random, const Room& room) {
  constexpr double kDoorway = 1.0;  // kept free along every wall
  const double width = room.width() - 2.0 * kDoorway;
  const double height = room.height() - 2.0 * kDoorway;
  if (width < 0.6 || height < 0.6) return;
  const auto inside = [&](double margin) {
    return Point2{random.uniform(room.left + margin, room.right - margin),
                  random.uniform(room.bottom + margin, room.top - margin)};
  };

  const double area = room.width() * room.height();
  const int cabinets = random.pick(0, std::clamp(static_cast<int>(area / 8.0), 1, 6));
  for (int i = 0; i < cabinets; ++i) {  // with its back to a wall
    const double length = random.uniform(0.6, 2.0);
    const double depth = random.uniform(0.35, 0.65);
    const Point2 at = inside(0.5 * length + 0.3);
    switch (random.pick(0, 3)) {
      case 0:
        pen.box({at.x, room.bottom + 0.1 + 0.5 * depth}, length, depth);
        break;
      case 1:
        pen.box({at.x, room.top - 0.1 - 0.5 * depth}, length, depth);
        break;
      case 2:
        pen.box({room.left + 0.1 + 0.5 * depth, at.y}, depth, length);
        break;
      default:
        pen.box({room.right - 0.1 - 0.5 * depth, at.y}, depth, length);
        break;
    }
  }
  const int pieces = std::clamp(static_cast<int>(area / random.uniform(6.0, 14.0)), 1, 12);
  for (int i = 0; i < pieces; ++i) {
    const Point2 at = inside(kDoorway);
    switch (random.pick(0, 4)) {
      case 0: {
        const int front = random.chance(0.5) ? 1 : -1;
        const int side = random.chance(0.5) ? 1 : -1;
        pen.desk(at, side, front);
        break;
      }
      case 1: {
        const double across = random.uniform(0.7, 1.2);
        const double length = random.uniform(0.8, 2.4);
        pen.table(at, length, across);
        break;
      }
      case 2:
        pen.chair(at);
        break;
      case 3:
        pen.pillar(at, random.uniform(0.1, 0.25));
        break;
      default: {
        const double angle = random.uniform(0.0, 6.283);
        const double across = random.uniform(0.4, 0.8);
        const double length = random.uniform(0.5, 1.6);
        pen.box(at, length, across, {std::cos(angle), std::sin(angle)});
      }
    }
  }
}

void draw_row_of_rooms(const Hands& hands, double length, double depth) {
  if (length < 2.0 || depth < 1.5) {
    hands.pen.wall({0.0, 0.0}, {length, 0.0});
    return;
  }
  Random& random = hands.walls;
  const double usual = std::min(random.uniform(2.7, 5.2), length);
  const double door_at = random.uniform(0.3, usual - 1.4);  // the same in nearly every room
  std::vector<Door> doors;
  double at = 0.0;
  while (at < length) {
    double width = usual * (random.chance(0.2) ? 2.0 : 1.0);
    width *= random.chance(0.15) ? 1.3 : 1.0;
    if (length - at - width < 0.8 * usual) width = length - at;
    const double offset = random.chance(0.75) ? door_at : random.uniform(0.3, width - 1.4);
    const double door_width = random.chance(0.15) ? 1.4 : 0.9;
    const bool open = offset + door_width + 0.2 < width;
    if (open) doors.push_back({at + offset, door_width, random.pick(0, 2) == 0 ? 1 : 0});
    if (at + width < length) {
      if (random.chance(0.1)) {  // to the next room
        hands.pen.wall({at + width, 0.0}, {at + width, depth}, {{random.uniform(0.4, depth - 1.3), 0.9, 0}});
      } else {
        hands.pen.wall({at + width, 0.0}, {at + width, depth});
      }
    }
    if (hands.furniture.chance(0.85)) furnish(hands.pen, hands.furniture, {at, 0.0, at + width, depth});
    at += width;
  }
  hands.pen.wall({0.0, 0.0}, {length, 0.0}, doors, random.chance(0.1) ? kGlass : 1.0);
}

}  // namespace gridmerge::internal
