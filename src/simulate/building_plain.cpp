// SPDX-License-Identifier: Apache-2.0
// Buildings with long bare walls and few things to tell places by.
#include <algorithm>
#include <array>
#include <optional>
#include <vector>

#include "simulate/painted_floor.hpp"

namespace gridmerge::internal {

namespace {

struct Stretch {
  Room room;
  bool along_x;
};

/// A corridor of `length` along x, in a strip `depth` deep: straight, with a bend to the side and back, or
/// with a branch.
std::vector<Stretch> lay_corridor(Random& random, double length, double depth) {
  const double corridor = std::min(random.uniform(1.7, 3.2), 0.35 * depth);
  const double shape = random.uniform();
  const bool is_straight = shape < 0.35, is_bent = shape < 0.7;
  double low = random.uniform(0.25, 0.75) * (depth - corridor);
  const double turn_at = random.uniform(0.3, 0.7) * (length - corridor);
  if (is_straight || depth < 3.0 * corridor + 2.0) return {{{0.0, low, length, low + corridor}, true}};

  // The second stretch goes to the side where more of the strip is left.
  const bool mirrored = random.chance(0.5);
  low = random.uniform(0.05, 0.35) * (depth - corridor);
  std::vector<Stretch> stretches;
  if (is_bent) {
    const double beyond = low + corridor + random.uniform(1.5, std::min(12.0, depth - low - 2.0 * corridor));
    stretches = {{{0.0, low, turn_at + corridor, low + corridor}, true},
                 {{turn_at, low, turn_at + corridor, beyond + corridor}, false},
                 {{turn_at, beyond, length, beyond + corridor}, true}};
  } else {
    const double branch = random.chance(0.3) ? 0.8 * corridor : corridor;
    const double end = low + corridor + random.uniform(0.5, 1.0) * (depth - low - corridor);
    stretches = {{{0.0, low, length, low + corridor}, true}, {{turn_at, low, turn_at + branch, end}, false}};
  }
  if (mirrored) {
    for (Stretch& stretch : stretches)
      stretch.room = {stretch.room.left, depth - stretch.room.top, stretch.room.right,
                      depth - stretch.room.bottom};
  }
  return stretches;
}

std::array<Side, 2> sides_of(const Stretch& stretch) {
  return stretch.along_x ? std::array{Side::bottom, Side::top} : std::array{Side::left, Side::right};
}

/// Radiators, cupboards and fire hoses along a wall, never before an opening.
void line_wall(Draughtsman& pen, Random& random, const PaintedFloor& floor, const Room& room, Side side) {
  constexpr double kFree = 0.4;  // of wall to the next opening [m]
  constexpr double kDepth = 0.3;
  const bool along_x = side == Side::bottom || side == Side::top;
  const double length = along_x ? room.width() : room.height();
  for (double at = random.uniform(2.0, 40.0); at < length - 2.0; at += random.uniform(15.0, 60.0)) {
    const double size = random.uniform(0.3, 1.2);
    // A strip of no depth behind the wall fits only where nothing opens.
    const std::optional<Room> behind =
        floor.beside(room, side, at - 0.5 * size - kFree, size + 2.0 * kFree, 0.0);
    if (!behind) continue;
    const double middle_x = 0.5 * (behind->left + behind->right);
    const double middle_y = 0.5 * (behind->bottom + behind->top);
    const double inset = 0.08 + 0.5 * kDepth;
    switch (side) {
      case Side::bottom:
        pen.box({middle_x, middle_y + inset}, size, kDepth);
        break;
      case Side::top:
        pen.box({middle_x, middle_y - inset}, size, kDepth);
        break;
      case Side::left:
        pen.box({middle_x + inset, middle_y}, kDepth, size);
        break;
      case Side::right:
        pen.box({middle_x - inset, middle_y}, kDepth, size);
        break;
    }
  }
}

void draw_long_corridor(Draughtsman& pen, Random& random, double length, double depth) {
  PaintedFloor floor({0.0, 0.0, length, depth});
  const int space = floor.new_space();
  const std::vector<Stretch> stretches = lay_corridor(random, length, depth);
  for (const Stretch& stretch : stretches) floor.paint(stretch.room, space);
  const Features features{4.0, 15.0, random.uniform(0.4, 0.7), random.uniform(0.1, 0.3), 6.0};
  for (const Stretch& stretch : stretches) {
    for (const Side side : sides_of(stretch))
      add_features(floor, random, stretch.room, side, space, features);
  }
  floor.draw_walls(pen);
  for (const Stretch& stretch : stretches) {
    for (const Side side : sides_of(stretch)) line_wall(pen, random, floor, stretch.room, side);
  }
}

}  // namespace

void draw_corridor(Draughtsman& pen, Random& random, double width, double height) {
  if (width >= height) return draw_long_corridor(pen, random, width, height);
  Draughtsman turned;
  draw_long_corridor(turned, random, height, width);
  for (const Edge& edge : turned.edges)
    pen.edges.push_back({{edge.a.y, edge.a.x}, {edge.b.y, edge.b.x}, edge.echo});
}

void draw_bare(Draughtsman& pen, Random& random, double width, double height) {
  const double rim = std::min(random.uniform(2.5, 5.0), 0.18 * std::min(width, height));
  const int always = random.pick(0, 3);  // the side that has a rim for certain
  std::array<double, 4> inset{};
  for (int i = 0; i < 4; ++i)
    inset[static_cast<std::size_t>(i)] = i == always || random.chance(0.6) ? rim : 0.0;
  const Room hall{inset[0], inset[1], width - inset[2], height - inset[3]};
  PaintedFloor floor({0.0, 0.0, width, height});
  const int space = floor.new_space();
  floor.paint(hall, space);
  for (const Side side : {Side::bottom, Side::right, Side::top, Side::left}) {  // bays
    const double length = side == Side::bottom || side == Side::top ? hall.width() : hall.height();
    const double bay = random.uniform(0.15, 0.45) * length;
    const double at = random.uniform(0.0, length - bay);
    const double depth = random.uniform(0.3, 1.0) * rim;
    if (!random.chance(0.35)) continue;
    if (const std::optional<Room> made = floor.beside(hall, side, at, bay, depth)) floor.paint(*made, space);
  }
  const Features features{5.0, 20.0, 0.35, random.uniform(0.15, 0.45), rim};
  for (const Side side : {Side::bottom, Side::right, Side::top, Side::left})
    add_features(floor, random, hall, side, space, features);
  floor.draw_walls(pen);
  if (random.chance(0.4)) return;  // no pillars
  const double radius = random.uniform(0.15, 0.4);
  const double spacing = random.uniform(5.0, 9.0);
  const double left = hall.left + random.uniform(1.5, spacing);
  const double bottom = hall.bottom + random.uniform(1.5, spacing);
  const double share = random.chance(0.6) ? 1.0 : 0.85;
  for (double x = left; x < hall.right - 1.2; x += spacing) {
    for (double y = bottom; y < hall.top - 1.2; y += spacing) {
      if (random.chance(share)) pen.pillar({x, y}, radius);
    }
  }
}

}  // namespace gridmerge::internal
