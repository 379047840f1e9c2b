// SPDX-License-Identifier: Apache-2.0
#include "simulate/arena.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "simulate/building_parts.hpp"

namespace gridmerge::internal {

namespace {

/// A round place that something takes up.
struct Spot {
  Point2 at;
  double radius;
};

/// By a quarter turn, `times` over; exact.
Point2 turned(Point2 p, int times) {
  for (int i = 0; i < times; ++i) p = {-p.y, p.x};
  return p;
}

class ArenaBuilder {
 public:
  ArenaBuilder(Random& random, double width, double height) : random_(random) {
    arena_.folds = random.chance(0.5) ? 4 : 2;
    half_width_ = 0.5 * (arena_.folds == 4 ? std::min(width, height) : width);
    half_height_ = 0.5 * (arena_.folds == 4 ? std::min(width, height) : height);
  }

  Arena build() {
    add_walls();
    const double area = 4.0 * half_width_ * half_height_;
    if (random_.chance(0.5)) add_centre();
    const double each = random_.uniform(18.0, 40.0);  // floor for a thing [m^2]
    const int sets = std::max(2, static_cast<int>(area / each / arena_.folds));
    for (int i = 0; i < sets; ++i) add_set();
    const int lone = random_.pick(0, 5);
    for (int i = 0; i < lone; ++i) add_lone();
    return std::move(arena_);
  }

 private:
  /// Adds what `draw` draws, and its turned copies.
  void add_copies(const std::vector<Edge>& edges) {
    for (int i = 0; i < arena_.folds; ++i) {
      const int times = i * (4 / arena_.folds);
      for (const Edge& edge : edges)
        arena_.symmetric.push_back({turned(edge.a, times), turned(edge.b, times), edge.echo});
    }
  }

  void add_walls() {
    Draughtsman pen;
    const double w = half_width_, h = half_height_;
    pen.wall({-w, -h}, {w, -h});
    if (arena_.folds == 2) pen.wall({w, -h}, {w, h});
    if (random_.chance(0.6)) {  // a buttress
      const double at = random_.uniform(-0.8, 0.8) * w;
      const double length = random_.uniform(0.6, 3.0), depth = random_.uniform(0.4, 1.2);
      pen.box({at, -h + 0.5 * depth}, length, depth);
      take({at, -h + 0.5 * depth}, 0.5 * length + 0.3);
    }
    add_copies(pen.edges);
  }

  void add_centre() {
    const double longer = random_.uniform(0.06, 0.16) * std::min(half_width_, half_height_) * 2.0;
    const double shorter = arena_.folds == 4 ? longer : random_.uniform(0.4, 1.0) * longer;
    const Point2 a{0.5 * longer, 0.5 * shorter}, b{0.5 * longer, -0.5 * shorter};
    add_copies(arena_.folds == 4 ? std::vector<Edge>{{b, a}} : std::vector<Edge>{{b, a}, {a, {-a.x, a.y}}});
    taken_.push_back({{0.0, 0.0}, std::hypot(a.x, a.y)});
  }

  void take(Point2 at, double radius) {
    for (int i = 0; i < arena_.folds; ++i) taken_.push_back({turned(at, i * (4 / arena_.folds)), radius});
  }

  /// Whether a thing leaves a way past all others, its own copies and the walls.
  bool is_room_for(Point2 at, double radius) const {
    constexpr double kWay = 0.8;  // [m]
    if (std::abs(at.x) > half_width_ - radius - kWay || std::abs(at.y) > half_height_ - radius - kWay)
      return false;
    for (int i = 1; i < arena_.folds; ++i) {
      const Point2 copy = turned(at, i * (4 / arena_.folds));
      if (std::hypot(at.x - copy.x, at.y - copy.y) < 2.0 * radius + kWay) return false;
    }
    return std::all_of(taken_.begin(), taken_.end(), [&](const Spot& spot) {
      return std::hypot(at.x - spot.at.x, at.y - spot.at.y) >= radius + spot.radius + kWay;
    });
  }

  /// A free spot for a thing of `radius`, taken in all its copies; its radius is 0 where none was found.
  Spot find_spot(double radius) {
    constexpr int kTries = 60;
    for (int i = 0; i < kTries; ++i) {
      const Point2 at{random_.uniform(-half_width_, half_width_),
                      random_.uniform(-half_height_, half_height_)};
      if (!is_room_for(at, radius)) continue;
      take(at, radius);
      return {at, radius};
    }
    return {{}, 0.0};
  }

  Point2 any_direction() {
    if (random_.chance(0.65)) return {1.0, 0.0};
    const double angle = random_.uniform(0.0, std::numbers::pi);
    return {std::cos(angle), std::sin(angle)};
  }

  void add_set() {
    Draughtsman pen;
    const double most = 0.1 * std::min(half_width_, half_height_) + 0.8;  // half the length of a thing [m]
    switch (random_.pick(0, 3)) {
      case 0: {
        const double radius = random_.uniform(0.15, 0.45);
        const Spot spot = find_spot(radius);
        if (spot.radius > 0.0) pen.pillar(spot.at, radius);
        break;
      }
      case 1: {  // two walls that meet at a corner
        const double half = random_.uniform(0.5, 1.0) * most;
        const double x = random_.chance(0.5) ? half : -half, y = random_.chance(0.5) ? half : -half;
        const Spot spot = find_spot(1.5 * half);
        if (spot.radius == 0.0) break;
        pen.wall({spot.at.x - x, spot.at.y - y}, {spot.at.x + x, spot.at.y - y});
        pen.wall({spot.at.x - x, spot.at.y - y}, {spot.at.x - x, spot.at.y + y});
        break;
      }
      default: {
        const double length = random_.uniform(0.5, 2.0 * most), width = random_.uniform(0.3, 1.0) * length;
        const Spot spot = find_spot(0.5 * std::hypot(length, width));
        if (spot.radius > 0.0)
          pen.box(spot.at, length, width, random_.chance(0.3) ? Point2{0.0, 1.0} : any_direction());
      }
    }
    add_copies(pen.edges);
  }

  void add_lone() {
    const double radius = random_.uniform(0.15, 0.4);
    const Spot spot = find_spot(radius);
    if (spot.radius == 0.0) return;
    Draughtsman pen;
    pen.pillar(spot.at, radius);
    arena_.lone.push_back(pen.edges);
  }

  Random& random_;
  Arena arena_;
  double half_width_ = 0.0;
  double half_height_ = 0.0;
  std::vector<Spot> taken_;
};

}  // namespace

Arena make_arena(Random& random, double width, double height) {
  return ArenaBuilder(random, width, height).build();
}

void draw_arena(Draughtsman& pen, Random& random, double width, double height) {
  const Arena arena = make_arena(random, width, height);
  const SE2 T_building_arena{0.5 * width, 0.5 * height, 0.0};
  place(pen, arena.symmetric, T_building_arena);
  for (const std::vector<Edge>& lone : arena.lone) place(pen, lone, T_building_arena);
}

}  // namespace gridmerge::internal
