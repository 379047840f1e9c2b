// SPDX-License-Identifier: Apache-2.0
// Buildings of few large spaces, and the yard.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "simulate/building_parts.hpp"

namespace gridmerge::internal {

namespace {

Point2 direction(double angle) {
  return {std::cos(angle), std::sin(angle)};
}

/// A wall along an arc about `centre`, in pieces of about a metre, with a door in every piece that `is_door`
/// picks.
template <typename IsDoor>
void draw_arc(Draughtsman& pen, Point2 centre, double radius, double from, double to, IsDoor is_door) {
  const int pieces = std::max(3, static_cast<int>(radius * (to - from) / 1.1));
  const auto at = [&](int i) {
    const Point2 u = direction(from + (to - from) * i / pieces);
    return Point2{centre.x + radius * u.x, centre.y + radius * u.y};
  };
  for (int i = 0; i < pieces; ++i) {
    if (!is_door(i)) pen.wall(at(i), at(i + 1));
  }
}

void draw_bush(Draughtsman& pen, Random& random, Point2 centre, double radius) {
  std::vector<Point2> corners;
  const int count = random.pick(6, 10);
  for (int i = 0; i < count; ++i) {
    const Point2 u = direction(2.0 * std::numbers::pi * i / count);
    const double r = radius * random.uniform(0.6, 1.2);
    corners.push_back({centre.x + r * u.x, centre.y + r * u.y});
  }
  pen.polygon(corners, random.uniform(0.7, 1.0));
}

}  // namespace

void draw_hall(Draughtsman& pen, Random& random, double width, double height) {
  // The lower side has rooms, the others recesses.
  const double depth = std::min(4.5, 0.25 * height);
  Random furniture = random.fork();
  {
    Draughtsman rooms;
    draw_row_of_rooms({rooms, random, furniture}, width, depth);
    place(pen, rooms.edges, {width, depth, std::numbers::pi});
  }
  pen.wall({0.0, 0.0}, {width, 0.0});
  const double recess = std::min(random.uniform(1.0, 3.0), 0.15 * height);
  const double cut_from = random.uniform(0.1, 0.4) * width;
  const double cut_to = cut_from + random.uniform(0.15, 0.4) * width;
  const std::vector<Point2> outline{
      {width, 0.0},       {width, height - recess},          {cut_to, height - recess},    {cut_to, height},
      {cut_from, height}, {cut_from, height - 0.5 * recess}, {0.0, height - 0.5 * recess}, {0.0, 0.0}};
  for (std::size_t i = 0; i + 1 < outline.size(); ++i) {
    if (random.chance(0.3)) {
      pen.window_front(outline[i], outline[i + 1]);
    } else {
      pen.wall(outline[i], outline[i + 1]);
    }
  }
  const double spacing = random.uniform(4.5, 8.0);
  const double shift = random.uniform(1.5, spacing);
  for (double x = shift; x < width - 1.0; x += spacing) {
    for (double y = depth + 2.5; y < height - recess - 1.0; y += spacing) {
      if (random.chance(0.85)) pen.pillar({x, y}, 0.3);
    }
  }
  const int pieces = static_cast<int>(width * height / 45.0);  // counters, kiosks, benches
  for (int i = 0; i < pieces; ++i) {
    const Point2 along =
        random.chance(0.7) ? Point2{1.0, 0.0} : direction(random.uniform(0.0, std::numbers::pi));
    const double across = random.uniform(0.5, 1.5);
    const double length = random.uniform(0.6, 3.5);
    const Point2 at{random.uniform(1.5, width - 1.5), random.uniform(depth + 1.5, height - recess - 1.5)};
    pen.box(at, length, across, along);
  }
}

void draw_warehouse(Draughtsman& pen, Random& random, double width, double height) {
  pen.wall({0.0, 0.0}, {width, 0.0});
  pen.wall({width, 0.0}, {width, height});
  pen.wall({0.0, height}, {0.0, 0.0});
  const double dock = std::min(4.0, 0.2 * height);  // kept free along the upper side
  pen.wall({width, height}, {0.0, height});
  for (double x = 3.0; x < width - 4.0; x += random.uniform(4.5, 6.0)) {
    pen.box({x, height - 0.25}, 0.5, 0.5);
    if (random.chance(0.4)) pen.box({x + 2.0, height - 0.9}, 1.2, 1.0);
  }
  const double office = std::min(random.uniform(3.5, 6.0), 0.3 * height);
  pen.wall({0.0, office}, {office * 1.4, office}, {{0.8, 0.9, 1}});
  pen.wall({office * 1.4, 0.0}, {office * 1.4, office});
  furnish(pen, random, {0.0, 0.0, office * 1.4, office});

  const double bay = 2.7, rack = random.uniform(1.0, 2.2), aisle = random.uniform(2.2, 3.2);
  const int bays = random.pick(5, 9);
  for (double y = office + aisle; y + rack < height - dock; y += rack + aisle) {
    int since = 0;
    for (double x = 1.8; x + bay < width - 1.8; x += bay) {
      pen.pillar({x, y}, 0.06);
      pen.pillar({x, y + rack}, 0.06);
      if (++since > bays) {  // a cross aisle
        since = 0;
        continue;
      }
      if (random.chance(0.88)) {  // goods, which do not fill their bay wholly
        const double length = bay - random.uniform(0.1, 0.9);
        const double depth = rack - random.uniform(0.05, 0.35);
        pen.box({x + 0.5 * bay, y + 0.5 * rack}, length, depth);
      }
    }
  }
}

void draw_curved(Draughtsman& pen, Random& random, double width, double height) {
  const double outer = std::min(0.5 * width, height);
  const Point2 centre{0.5 * width, 0.0};
  const double thickness = std::min(random.uniform(11.0, 14.0), 0.7 * outer);
  const double inner = outer - thickness;
  const double corridor = 0.18 * thickness;
  const double low = inner + random.uniform(0.35, 0.45) * thickness;
  const double high = low + corridor;
  const double span = std::numbers::pi;
  Random furniture = random.fork();
  const auto none = [](int) { return false; };
  draw_arc(pen, centre, outer, 0.0, span, none);
  draw_arc(pen, centre, inner, 0.0, span, none);
  const auto row = [&](double from, double to, double door_radius) {
    const int rooms = std::max(2, static_cast<int>(span * door_radius / random.uniform(3.2, 5.0)));
    const double width_pieces = std::max(3, static_cast<int>(door_radius * span / 1.1)) / double(rooms);
    draw_arc(pen, centre, door_radius, 0.0, span,
             [&](int piece) { return std::fmod(piece + 0.5, width_pieces) < 1.0; });
    for (int i = 1; i < rooms; ++i) {
      // Partitions are slanted a little, no two alike.
      const Point2 u = direction(span * (i + random.uniform(-0.1, 0.1)) / rooms);
      const Point2 v = direction(span * (i + random.uniform(-0.1, 0.1)) / rooms);
      pen.wall({centre.x + from * u.x, centre.y + from * u.y}, {centre.x + to * v.x, centre.y + to * v.y});
    }
    for (int i = 0; i < rooms; ++i) {
      if (!furniture.chance(0.85)) continue;
      const double middle = 0.5 * (from + to);
      for (int k = furniture.pick(1, 3); k > 0; --k) {
        const Point2 u = direction(span * (i + furniture.uniform(0.25, 0.75)) / rooms);
        const double r = middle + furniture.uniform(-0.25, 0.25) * (to - from);
        const double across = furniture.uniform(0.4, 0.8);
        const double length = furniture.uniform(0.5, 1.6);
        pen.box({centre.x + r * u.x, centre.y + r * u.y}, length, across, u);
      }
    }
  };
  row(inner, low, low);
  row(high, outer, high);
  for (const double side : {-1.0, 1.0})
    pen.wall({centre.x + side * inner, 0.0}, {centre.x + side * outer, 0.0});
}

void draw_outdoor(Draughtsman& pen, Random& random, double width, double height) {
  const double slant = random.uniform(0.0, 0.12) * height;  // plots are no rectangles
  const std::vector<Point2> fence{{0.0, slant}, {width, 0.0}, {width, height}, {0.2 * width, height}};
  for (std::size_t i = 0; i < fence.size(); ++i) pen.wall(fence[i], fence[(i + 1) % fence.size()], {}, 0.85);
  const auto somewhere = [&](double margin) {
    return Point2{random.uniform(margin, width - margin), random.uniform(margin, height - margin)};
  };
  const double area = width * height;
  for (int i = std::max(1, static_cast<int>(area / 350.0)); i > 0; --i) {  // houses, some of them L-shaped
    const Point2 u = direction(random.uniform(0.0, std::numbers::pi));
    const Point2 at = somewhere(0.2 * std::min(width, height));
    const double length = random.uniform(0.15, 0.3) * std::min(width, height) + 1.5;
    const double depth = random.uniform(0.5, 0.9) * length;
    pen.box(at, length, depth, u);
    if (random.chance(0.6)) {
      pen.box({at.x + 0.4 * length * u.x - 0.5 * depth * u.y, at.y + 0.4 * length * u.y + 0.5 * depth * u.x},
              0.4 * length, 0.6 * depth, u);
    }
  }
  for (int i = static_cast<int>(area / 40.0); i > 0; --i) {  // trees
    const double radius = random.uniform(0.1, 0.35);
    pen.pillar(somewhere(1.0), radius);
  }
  for (int i = static_cast<int>(area / 60.0); i > 0; --i) {
    const double radius = random.uniform(0.4, 1.4);
    draw_bush(pen, random, somewhere(1.0), radius);
  }
  for (int i = static_cast<int>(area / 150.0); i > 0; --i) {  // cars
    const Point2 along = direction(random.uniform(0.0, std::numbers::pi));
    pen.box(somewhere(2.5), 4.2, 1.8, along);
  }
}

}  // namespace gridmerge::internal
