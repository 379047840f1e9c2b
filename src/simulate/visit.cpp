// SPDX-License-Identifier: Apache-2.0
#include "simulate/visit.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

namespace gridmerge::internal {

namespace {

constexpr double kWalker = 0.2;      // radius [m]
constexpr double kWalkerStep = 0.4;  // while a robot goes from scan to scan [m]

Point2 any_direction(Random& random) {
  const double angle = random.uniform(0.0, 2.0 * std::numbers::pi);
  return {std::cos(angle), std::sin(angle)};
}

double area_of(const FloorPlan& plan) {
  return plan.count_free() * FloorPlan::kCell * FloorPlan::kCell;
}

Point2 anywhere_on(const FloorPlan& plan, Random& random) {
  return plan.centre(
      plan.free_cells()[static_cast<std::size_t>(random.pick(0, static_cast<int>(plan.count_free()) - 1))]);
}

}  // namespace

namespace {

std::vector<Edge> scatter(const FloorPlan& clear, int pieces, Random& random) {
  Draughtsman pen;
  for (int i = 0; i < pieces; ++i) {
    const Point2 at = anywhere_on(clear, random);
    switch (random.pick(0, 3)) {
      case 0:
        pen.chair(at);
        break;
      case 1:
        pen.pillar(at, random.uniform(0.1, 0.25));
        break;
      default: {
        const Point2 along = any_direction(random);
        const double across = random.uniform(0.25, 0.6);
        const double length = random.uniform(0.3, 1.0);
        pen.box(at, length, across, along);
      }
    }
  }
  return pen.edges;
}

}  // namespace

Visit make_visit(const std::vector<Edge>& building, const FloorPlan& plan, double robot_radius, int start,
                 double clutter, Random& random) {
  constexpr double kClear = 0.7;     // a doorway is narrower than twice that [m]
  constexpr double kMinLeft = 0.85;  // of the floor
  const FloorPlan clear(building, kClear);
  int pieces = static_cast<int>(clutter * area_of(plan) / 25.0 + random.uniform());
  if (clear.count_free() == 0) pieces = 0;
  while (true) {
    std::vector<Edge> edges = building;
    const std::vector<Edge> clutter_edges = scatter(clear, pieces, random);
    edges.insert(edges.end(), clutter_edges.begin(), clutter_edges.end());
    FloorPlan cluttered(edges, robot_radius);
    if (pieces == 0 || (cluttered.is_free(start) && cluttered.count_free() > kMinLeft * plan.count_free()))
      return {RayCaster(std::move(edges)), std::move(cluttered)};
    pieces = 4 * pieces / 5;
  }
}

Walkers::Walkers(const FloorPlan& plan, double clutter, Random random) : plan_(plan), random_(random) {
  const int count = static_cast<int>(clutter * area_of(plan) / 150.0 + random_.uniform());
  for (int i = 0; i < count; ++i) {
    const Point2 u = any_direction(random_);
    walkers_.push_back({anywhere_on(plan, random_), {kWalkerStep * u.x, kWalkerStep * u.y}});
  }
}

void Walkers::walk() {
  for (Walker& walker : walkers_) {
    const Point2 next{walker.at.x + walker.step.x, walker.at.y + walker.step.y};
    const int cell = plan_.cell_at(next);
    if (cell >= 0 && plan_.is_free(cell)) {
      walker.at = next;
      continue;
    }
    const Point2 u = any_direction(random_);
    walker.step = {kWalkerStep * u.x, kWalkerStep * u.y};
  }
}

double Walkers::distance_to(Point2 from, Point2 direction, double range) const {
  double nearest = std::numeric_limits<double>::infinity();
  for (const Walker& walker : walkers_) {
    const Point2 d{walker.at.x - from.x, walker.at.y - from.y};
    const double along = d.x * direction.x + d.y * direction.y;
    const double square = kWalker * kWalker - (d.x * d.x + d.y * d.y - along * along);
    if (along <= 0.0 || square <= 0.0) continue;
    const double distance = along - std::sqrt(square);
    if (distance > 0.0 && distance <= range) nearest = std::min(nearest, distance);
  }
  return nearest;
}

}  // namespace gridmerge::internal
