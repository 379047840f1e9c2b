// SPDX-License-Identifier: Apache-2.0
// Buildings of corridors and rooms.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "simulate/building_parts.hpp"

namespace gridmerge::internal {

namespace {

/// Lays a row of rooms along a corridor's wall that starts at T_building_row's origin, along its x axis.
void place_row(Draughtsman& pen, Random& walls, Random& furniture, const SE2& T_building_row, double length,
               double depth) {
  Draughtsman row;
  draw_row_of_rooms({row, walls, furniture}, length, depth);
  place(pen, row.edges, T_building_row);
}

/// A storey of corridors along x with rooms on both sides, without its outer walls. Cross corridors lead from
/// one corridor to the next.
void draw_storey(Draughtsman& pen, Random& walls, Random& furniture, const Room& floor) {
  const int corridors = std::max(1, static_cast<int>(std::lround(floor.height() / 15.0)));
  const double corridor = std::min(walls.uniform(1.7, 2.6), 0.35 * floor.height());
  const double band = floor.height() / corridors;
  std::vector<double> cuts;  // centres of cross corridors
  if (corridors > 1) {
    for (double x = floor.left + walls.uniform(3.0, 0.3 * floor.width()); x < floor.right - 3.0;
         x += walls.uniform(14.0, 30.0))
      cuts.push_back(x);
  }
  for (int i = 0; i < corridors; ++i) {
    const double bottom = floor.bottom + i * band;
    const double middle = bottom + band * walls.uniform(0.42, 0.58);
    const double low = middle - 0.5 * corridor;
    const double high = middle + 0.5 * corridor;
    double from = floor.left;
    for (std::size_t k = 0; k <= cuts.size(); ++k) {
      const bool last = k == cuts.size();
      const double to = last ? floor.right : cuts[k] - 0.5 * corridor;
      const bool cut_below = i > 0, cut_above = i + 1 < corridors;
      const auto row = [&](bool above, bool cut) {
        const double start = cut || k == 0 ? from : from - corridor;
        const double length = to - start;
        if (length <= 0.0) return;
        const double depth = above ? bottom + band - high : low - bottom;
        place_row(pen, walls, furniture, above ? SE2{start, high, 0.0} : SE2{to, low, std::numbers::pi},
                  length, depth);
        const double back = above ? bottom + band : bottom;
        const double front = above ? high : low;
        if (cut && k > 0) pen.wall({start, front}, {start, back});
        pen.wall({to, front}, {to, back});
        if (cut && above) pen.wall({start, back}, {to, back});
      };
      row(false, cut_below);
      row(true, cut_above);
      from = last ? from : cuts[k] + 0.5 * corridor;
    }
  }
}

void divide(Draughtsman& pen, Random& random, const Room& room, double least) {
  const bool across = room.width() >= room.height();
  const double side = across ? room.width() : room.height();
  const double other = across ? room.height() : room.width();
  if (side < 2.0 * least || (side < 3.2 * least && random.chance(0.25))) {
    furnish(pen, random, room);
    return;
  }
  const double at = random.uniform(least, side - least);
  std::vector<Door> doors{{random.uniform(0.3, other - 1.3), 0.9, random.pick(-1, 1)}};
  if (other > 8.0) doors = {{random.uniform(0.3, 0.4 * other), 0.9, 0}, {0.6 * other, 1.2, 0}};
  if (across) {
    pen.wall({room.left + at, room.bottom}, {room.left + at, room.top}, doors);
    divide(pen, random, {room.left, room.bottom, room.left + at, room.top}, least);
    divide(pen, random, {room.left + at, room.bottom, room.right, room.top}, least);
  } else {
    pen.wall({room.left, room.bottom + at}, {room.right, room.bottom + at}, doors);
    divide(pen, random, {room.left, room.bottom, room.right, room.bottom + at}, least);
    divide(pen, random, {room.left, room.bottom + at, room.right, room.top}, least);
  }
}

}  // namespace

void draw_office(Draughtsman& pen, Random& random, double width, double height) {
  const Room floor{0.0, 0.0, width, height};
  draw_shell(pen, random, floor);
  Random furniture = random.fork();
  draw_storey(pen, random, furniture, floor);
}

void draw_apartment(Draughtsman& pen, Random& random, double width, double height) {
  const Room floor{0.0, 0.0, width, height};
  draw_shell(pen, random, floor);
  divide(pen, random, floor, random.uniform(2.2, 3.0));
}

void draw_symmetric(Draughtsman& pen, Random& random, double width, double height) {
  // The lobby in the middle is as wide as a fifth of the building.
  const double lobby = std::max(2.5, 0.2 * width);
  const Room wing{0.0, 0.0, 0.5 * (width - lobby), height};
  const Random walls = random.fork();
  for (const bool turned : {false, true}) {
    Draughtsman half;
    Random same_walls = walls;
    Random furniture = random.fork();
    half.window_front({wing.right + 0.5 * lobby, 0.0}, {0.0, 0.0});
    half.wall({0.0, 0.0}, {0.0, height});
    half.wall({0.0, height}, {wing.right + 0.5 * lobby, height});
    draw_storey(half, same_walls, furniture, wing);
    for (double y = 2.0; y < 0.4 * height; y += 4.0) half.pillar({wing.right + 0.2 * lobby, y}, 0.25);
    half.box({wing.right + 0.5 * lobby, 0.3 * height}, 0.35 * lobby, 1.5);  // stairs
    place(pen, half.edges, turned ? SE2{width, height, std::numbers::pi} : SE2{});
  }
}

void draw_loop(Draughtsman& pen, Random& random, double width, double height) {
  draw_shell(pen, random, {0.0, 0.0, width, height});
  const double corridor = std::min(random.uniform(1.7, 2.4), 0.15 * std::min(width, height));
  const double depth = std::clamp(random.uniform(0.16, 0.24) * std::min(width, height), 1.5, 7.0);
  Random furniture = random.fork();
  const double length_x = width - 2.0 * depth;
  const double length_y = height - 2.0 * depth;
  place_row(pen, random, furniture, {width - depth, depth, std::numbers::pi}, length_x, depth);
  place_row(pen, random, furniture, {depth, height - depth, 0.0}, length_x, depth);
  place_row(pen, random, furniture, {depth, depth, 0.5 * std::numbers::pi}, length_y, depth);
  place_row(pen, random, furniture, {width - depth, height - depth, -0.5 * std::numbers::pi}, length_y,
            depth);
  const double inset = depth + corridor;
  const Room core{inset, inset, width - inset, height - inset};
  if (core.height() > 7.0 && random.chance(0.6)) {  // rooms, back to back
    const double half = 0.5 * core.height();
    place_row(pen, random, furniture, {core.left, core.bottom, 0.0}, core.width(), half);
    place_row(pen, random, furniture, {core.right, core.top, std::numbers::pi}, core.width(), half);
    pen.wall({core.left, core.bottom + half}, {core.right, core.bottom + half});
    pen.wall({core.left, core.bottom}, {core.left, core.top});
    pen.wall({core.right, core.bottom}, {core.right, core.top});
  } else {
    draw_shell(pen, random, core);  // a courtyard
  }
  for (int i = 0; i < static_cast<int>((length_x + length_y) / 12.0); ++i) {  // what stands in corridors
    const double x = random.uniform(core.left, core.right);
    const double length = random.uniform(0.5, 1.5);
    pen.box({x, random.chance(0.5) ? depth + 0.3 : height - depth - 0.3}, length, 0.4);
  }
}

}  // namespace gridmerge::internal
