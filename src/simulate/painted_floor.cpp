// SPDX-License-Identifier: Apache-2.0
#include "simulate/painted_floor.hpp"

#include <algorithm>
#include <cmath>

namespace gridmerge::internal {

namespace {

constexpr double kSame = 1e-6;  // coordinates that differ by less are one [m]

bool is_horizontal(Side side) {
  return side == Side::bottom || side == Side::top;
}

/// The coordinate that all points of a side have in common.
double line_of(const Room& room, Side side) {
  switch (side) {
    case Side::bottom:
      return room.bottom;
    case Side::right:
      return room.right;
    case Side::top:
      return room.top;
    case Side::left:
      break;
  }
  return room.left;
}

double length_of(const Room& room, Side side) {
  return is_horizontal(side) ? room.width() : room.height();
}

/// Sorted, each once.
void keep_distinct(std::vector<double>& values) {
  std::sort(values.begin(), values.end());
  const auto is_same = [](double a, double b) { return b - a < kSame; };
  values.erase(std::unique(values.begin(), values.end(), is_same), values.end());
}

}  // namespace

std::optional<Room> PaintedFloor::beside(const Room& room, Side side, double at, double length,
                                         double depth) const {
  constexpr double kApart = 0.3;  // from other floor: two walls fit between [m]
  Room made = room;
  Room around = room;  // kept free of other floor
  const double line = line_of(room, side);
  const bool outward_is_up = side == Side::right || side == Side::top;
  const double low = outward_is_up ? line : line - depth;
  const double high = outward_is_up ? line + depth : line;
  const double far_low = outward_is_up ? low : low - kApart;
  const double far_high = outward_is_up ? high + kApart : high;
  if (is_horizontal(side)) {
    made = {room.left + at, low, room.left + at + length, high};
    around = {made.left - kApart, far_low, made.right + kApart, far_high};
  } else {
    made = {low, room.bottom + at, high, room.bottom + at + length};
    around = {far_low, made.bottom - kApart, far_high, made.top + kApart};
  }
  if (at < 0.0 || at + length > length_of(room, side) || made.left < frame_.left ||
      made.right > frame_.right || made.bottom < frame_.bottom || made.top > frame_.top)
    return std::nullopt;
  for (const Part& part : parts_) {
    if (part.room.left < around.right - kSame && part.room.right > around.left + kSame &&
        part.room.bottom < around.top - kSame && part.room.top > around.bottom + kSame)
      return std::nullopt;
  }
  return made;
}

void PaintedFloor::open(const Room& room, Side side, double at, double width) {
  const bool upright = !is_horizontal(side);
  openings_.push_back({upright, line_of(room, side), (upright ? room.bottom : room.left) + at, width});
}

int PaintedFloor::space_at(Point2 p) const {
  const auto last = std::find_if(parts_.rbegin(), parts_.rend(), [&](const Part& part) {
    const Room& room = part.room;
    return p.x > room.left && p.x < room.right && p.y > room.bottom && p.y < room.top;
  });
  return last == parts_.rend() ? 0 : last->space;
}

void PaintedFloor::draw_run(Draughtsman& pen, bool upright, double line, double from, double to) const {
  std::vector<Door> doors;
  for (const Opening& opening : openings_) {
    if (opening.upright == upright && std::abs(opening.line - line) < kSame && opening.from > from &&
        opening.from + opening.width < to)
      doors.push_back({opening.from - from, opening.width, 0});
  }
  std::sort(doors.begin(), doors.end(), [](const Door& a, const Door& b) { return a.at < b.at; });
  if (upright) {
    pen.wall({line, from}, {line, to}, doors);
  } else {
    pen.wall({from, line}, {to, line}, doors);
  }
}

void PaintedFloor::draw_line(Draughtsman& pen, bool upright, const std::vector<double>& lines,
                             std::size_t line, const std::vector<double>& ticks) const {
  const double before = line == 0 ? lines[0] - 1.0 : 0.5 * (lines[line - 1] + lines[line]);
  const double after = line + 1 == lines.size() ? lines[line] + 1.0 : 0.5 * (lines[line] + lines[line + 1]);
  std::optional<double> from;
  for (std::size_t i = 0; i + 1 < ticks.size(); ++i) {
    const double middle = 0.5 * (ticks[i] + ticks[i + 1]);
    const int a = space_at(upright ? Point2{before, middle} : Point2{middle, before});
    const int b = space_at(upright ? Point2{after, middle} : Point2{middle, after});
    if (a != b && !from) from = ticks[i];
    if (a == b && from) {
      draw_run(pen, upright, lines[line], *from, ticks[i]);
      from.reset();
    }
  }
  if (from) draw_run(pen, upright, lines[line], *from, ticks.back());
}

void PaintedFloor::draw_walls(Draughtsman& pen) const {
  std::vector<double> xs, ys;
  for (const Part& part : parts_) {
    xs.insert(xs.end(), {part.room.left, part.room.right});
    ys.insert(ys.end(), {part.room.bottom, part.room.top});
  }
  keep_distinct(xs);
  keep_distinct(ys);
  for (std::size_t i = 0; i < xs.size(); ++i) draw_line(pen, true, xs, i, ys);
  for (std::size_t i = 0; i < ys.size(); ++i) draw_line(pen, false, ys, i, xs);
}

int add_features(PaintedFloor& floor, Random& random, const Room& room, Side side, int space,
                 const Features& features) {
  const double length = length_of(room, side);
  int added = 0;
  double at = random.uniform(0.6, features.most_gap);
  while (at < length - 0.6) {
    const double draw = random.uniform();
    double width = random.chance(0.25) ? 1.6 : 0.95;  // a double door, or a single one
    double depth = random.uniform(0.1, 0.25);
    const bool is_room = draw >= features.closed_doors && draw < features.closed_doors + features.rooms;
    if (is_room) {
      width = random.uniform(2.4, 6.0);
      depth = random.uniform(0.5, 1.0) * features.room_depth;
    } else if (draw >= features.closed_doors) {  // a niche
      width = random.uniform(1.0, 3.2);
      depth = random.uniform(0.4, 1.4);
    }
    const double gap = random.uniform(features.least_gap, features.most_gap);
    const double door = random.uniform(0.9, 1.3);
    const double door_at = random.uniform(0.3, width - door - 0.3);
    if (const std::optional<Room> made = floor.beside(room, side, at, width, depth)) {
      floor.paint(*made, is_room ? floor.new_space() : space);
      if (is_room) floor.open(room, side, at + door_at, door);
      ++added;
    }
    at += width + gap;
  }
  return added;
}

}  // namespace gridmerge::internal
