// SPDX-License-Identifier: Apache-2.0
#include "building.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace gridmerge::paper {

namespace {

constexpr double kHallLeft = 36.0, kHallRight = 66.0, kHallBottom = 36.0, kHallTop = 60.0;
constexpr double kDoor = 2.0;  // [m]

bool contains(const Floor& floor, const Point2& p) {
  return p.x >= floor.left && p.x < floor.right && p.y >= floor.bottom && p.y < floor.top;
}

std::vector<Point2> walk_along(const std::vector<Point2>& path, double step) {
  std::vector<Point2> stops{path.front()};
  for (std::size_t i = 1; i < path.size(); ++i) {
    const double length = std::hypot(path[i].x - path[i - 1].x, path[i].y - path[i - 1].y);
    const int steps = std::max(1, static_cast<int>(length / step));
    for (int k = 1; k <= steps; ++k) {
      const double share = static_cast<double>(k) / steps;
      stops.push_back({path[i - 1].x + share * (path[i].x - path[i - 1].x),
                       path[i - 1].y + share * (path[i].y - path[i - 1].y)});
    }
  }
  return stops;
}

Point2 middle_of(const std::vector<Point2>& points) {
  Point2 low = points.front();
  Point2 high = low;
  for (const Point2& p : points) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y)};
  }
  return {0.5 * (low.x + high.x), 0.5 * (low.y + high.y)};
}

}  // namespace

double Dice::roll() {  // SplitMix64 (Steele, Lea & Flood 2014)
  state_ += 0x9e3779b97f4a7c15ULL;
  std::uint64_t bits = state_;
  bits = (bits ^ (bits >> 30)) * 0xbf58476d1ce4e5b9ULL;
  bits = (bits ^ (bits >> 27)) * 0x94d049bb133111ebULL;
  bits ^= bits >> 31;
  return static_cast<double>(bits >> 11) / 9007199254740992.0;  // 2^53
}

Building::Building(std::uint64_t seed) {
  Dice dice(seed);
  floors_.push_back({kHallLeft, kHallBottom, kHallRight, kHallTop});
  const Floor west{4.0, 46.0, kHallLeft, 50.0}, east{kHallRight, 38.0, 96.0, 41.5};
  const Floor north{56.0, kHallTop, 60.0, 96.0}, south{40.0, 4.0, 43.0, kHallBottom};
  for (const Floor& corridor : {west, east, north, south}) floors_.push_back(corridor);
  add_rooms(dice, true, west.bottom, west.top, west.left, west.right - 1.0);
  add_rooms(dice, true, east.bottom, east.top, east.left + 1.0, east.right);
  add_rooms(dice, false, north.left, north.right, north.bottom + 1.0, north.top);
  add_rooms(dice, false, south.left, south.right, south.bottom, south.top - 1.0);
  floors_.push_back({kHallLeft, kHallTop, 44.0, kHallTop + 6.0});  // a niche: the hall has no symmetry
  for (int i = 0; i < 7; ++i) {                                    // what stands about in the hall
    const double x = dice.roll(kHallLeft + 2.0, kHallRight - 4.0);
    const double y = dice.roll(kHallBottom + 2.0, kHallTop - 4.0);
    obstacles_.push_back({x, y, x + dice.roll(0.5, 2.5), y + dice.roll(0.5, 2.5)});
  }
}

void Building::add_rooms(Dice& dice, bool along_x, double corridor_low, double corridor_high, double from,
                         double to) {
  constexpr double kWall = 0.5;
  const auto add = [&](double along0, double along1, double across0, double across1) {
    floors_.push_back(along_x ? Floor{along0, across0, along1, across1}
                              : Floor{across0, along0, across1, along1});
  };
  for (const int side : {-1, 1}) {
    for (double at = from; at + 5.0 < to;) {
      const double width = std::min(dice.roll(5.0, 11.0), to - at);
      const double depth = dice.roll(5.0, 9.0);
      const double door = at + dice.roll(0.5, width - kWall - kDoor);
      const double edge = side < 0 ? corridor_low : corridor_high;
      const double wall = edge + side * kWall;
      const double back = wall + side * depth;
      add(at, at + width - kWall, std::min(wall, back), std::max(wall, back));
      add(door, door + kDoor, std::min(edge, wall), std::max(edge, wall));
      at += width;
    }
  }
}

bool Building::is_floor(const Point2& p) const {
  const auto is_inside = [&](const Floor& floor) { return contains(floor, p); };
  return std::any_of(floors_.begin(), floors_.end(), is_inside) &&
         std::none_of(obstacles_.begin(), obstacles_.end(), is_inside);
}

RobotMap explore(const Building& building, const std::vector<Point2>& path, double range, int side,
                 double resolution, std::uint64_t seed) {
  Dice dice(seed);
  const double turn = dice.roll(-std::numbers::pi, std::numbers::pi);
  const Point2 middle = middle_of(path);
  const double half = 0.5 * side * resolution;
  RobotMap robot{make_grid(side, side, resolution, {-half, -half, 0.0}), {middle.x, middle.y, turn}};
  const SE2 T_grid_building = inverse(robot.T_building_map * robot.map.origin);
  const auto mark = [&](const Point2& p, Cell value) {
    const Point2 at = T_grid_building * p;
    const int column = static_cast<int>(std::floor(at.x / resolution));
    const int row = static_cast<int>(std::floor(at.y / resolution));
    if (!robot.map.contains(column, row)) return;
    Cell& cell = robot.map.at(column, row);
    cell = std::max(cell, value);  // a wall once seen stays
  };

  constexpr int kRays = 360;
  const double step = 0.25 * resolution;
  for (const Point2& stop : walk_along(path, 0.5)) {
    const double first = dice.roll(0.0, 1.0);  // of a ray: robots turn as they go
    for (int ray = 0; ray < kRays; ++ray) {
      const double angle = 2.0 * std::numbers::pi * (ray + first) / kRays;
      const double c = std::cos(angle), s = std::sin(angle);
      double reach = 0.0;
      while (reach < range && building.is_floor({stop.x + reach * c, stop.y + reach * s})) {
        mark({stop.x + reach * c, stop.y + reach * s}, Cell::free);
        reach += step;
      }
      if (reach < range) mark({stop.x + reach * c, stop.y + reach * s}, Cell::occupied);
    }
  }
  return robot;
}

}  // namespace gridmerge::paper
