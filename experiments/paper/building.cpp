// SPDX-License-Identifier: Apache-2.0
#include "building.hpp"

#include <algorithm>
#include <optional>

#include "simulate/painted_floor.hpp"
#include "simulate/random.hpp"

namespace gridmerge::paper {

using namespace internal;

namespace {

constexpr double kWidth = 96.0, kHeight = 86.0;  // [m]
constexpr double kDoor = 1.2;                    // [m]

/// Rooms of 5 to 9 m along one side of a corridor, each with a door to it.
void add_rooms(PaintedFloor& floor, Random& random, const Room& corridor, Side side) {
  const double length = side == Side::left || side == Side::right ? corridor.height() : corridor.width();
  double at = random.uniform(0.6, 2.0);
  while (at < length - 5.0) {
    const double width = std::min(random.uniform(5.0, 9.0), length - at - 0.5);
    const double depth = random.uniform(5.5, 9.0);
    const double door = at + random.uniform(0.5, width - kDoor - 0.5);
    const double gap = random.uniform(0.35, 1.0);
    if (const std::optional<Room> room = floor.beside(corridor, side, at, width, depth)) {
      floor.paint(*room, floor.new_space());
      floor.open(corridor, side, door, kDoor);
    }
    at += width + gap;
  }
}

/// Counters in the east of the hall, where the robots start, on both sides of their way; boxes elsewhere.
void furnish_hall(Draughtsman& pen, Random& random) {
  for (const double y : {35.4, 40.8}) {
    double x = kHallLeft + random.uniform(11.5, 12.5);
    while (x < kHallRight - 3.0) {
      const double length = random.uniform(1.0, 3.0), depth = random.uniform(0.5, 0.9);
      const double off = random.uniform(-0.5, 0.5);
      pen.box({x + 0.5 * length, y + off}, length, depth);
      x += length + random.uniform(0.5, 1.2);
    }
  }
  for (const double y : {33.0, 43.0}) {
    double x = kHallLeft + random.uniform(2.0, 5.0);
    while (x < kHallRight - 1.5) {
      const double length = random.uniform(0.8, 2.0), depth = random.uniform(0.6, 1.2);
      const bool is_north_way = y > 40.0 && x > 42.5 && x < 49.0;
      if (!is_north_way) pen.box({x, y}, length, depth);
      x += random.uniform(4.0, 8.0);
    }
  }
}

}  // namespace

Building make_entrance(std::uint64_t seed) {
  Random random(seed);
  PaintedFloor floor({0.0, 0.0, kWidth, kHeight});
  const int hall_space = floor.new_space();
  const Room hall{kHallLeft, kHallBottom, kHallRight, kHallTop};
  const Room west{4.0, 35.5, kHallLeft, 39.5}, east{kHallRight, 36.5, 92.0, 40.5};
  const Room north{44.0, kHallTop, 48.0, 78.0};
  floor.paint(hall, hall_space);
  for (const Room& corridor : {west, east, north}) floor.paint(corridor, hall_space);
  for (const Room& corridor : {west, east}) {
    add_rooms(floor, random, corridor, Side::bottom);
    add_rooms(floor, random, corridor, Side::top);
  }
  add_rooms(floor, random, north, Side::left);
  add_rooms(floor, random, north, Side::right);
  // A bay on the south side: the hall has no symmetry.
  if (const auto bay = floor.beside(hall, Side::bottom, random.uniform(12.0, 18.0), 4.0, 2.5))
    floor.paint(*bay, hall_space);

  Draughtsman pen;
  floor.draw_walls(pen);
  furnish_hall(pen, random);
  return {BuildingKind::hall, kWidth, kHeight, std::move(pen.edges)};
}

}  // namespace gridmerge::paper
