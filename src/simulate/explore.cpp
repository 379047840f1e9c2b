// SPDX-License-Identifier: Apache-2.0
#include "simulate/explore.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "gridmerge/grid/execution.hpp"

namespace gridmerge::internal {

namespace {

constexpr double kLookEvery = 0.9;  // of way [m]
constexpr double kEyesShare = 0.8;  // of the sensor's range
constexpr int kLooks = 120;         // rays of a look
constexpr double kSharpTurn = 1.0;  // a robot that turns by more scans on the way [rad]

}  // namespace

SeenFloor::SeenFloor(const FloorPlan& plan)
    : plan_(&plan),
      width_((plan.width() + kPlanCells - 1) / kPlanCells),
      seen_(static_cast<std::size_t>(width_) *
                ((plan.cells() / std::max(1, plan.width()) + kPlanCells - 1) / kPlanCells),
            0) {}

std::size_t SeenFloor::index(int plan_cell) const {
  const int row = plan_cell / plan_->width() / kPlanCells;
  return static_cast<std::size_t>(row) * width_ + plan_cell % plan_->width() / kPlanCells;
}

void SeenFloor::look(const RayCaster& caster, const SE2& from, double range, double cleared,
                     double field_of_view) {
  constexpr double kStep = 0.5 * kPlanCells * FloorPlan::kCell;
  for (int i = 0; i < kLooks; ++i) {
    const double angle = from.theta + field_of_view * ((i + 0.5) / kLooks - 0.5);
    const Point2 u{std::cos(angle), std::sin(angle)};
    const double met = caster.cast({from.x, from.y}, u, range).range;
    const double free = std::isinf(met) ? cleared : met;
    for (double at = 0.0; at <= free; at += kStep) {
      const int cell = plan_->cell_at({from.x + at * u.x, from.y + at * u.y});
      if (cell >= 0) seen_[index(cell)] = 1;
    }
  }
}

int SeenFloor::count() const {
  return static_cast<int>(std::count(seen_.begin(), seen_.end(), std::uint8_t{1}));
}

int count_common(const SeenFloor& a, const SeenFloor& b) {
  int common = 0;
  for (std::size_t i = 0; i < a.seen_.size(); ++i) common += a.seen_[i] & b.seen_[i];
  return common;
}

Exploration explore(const FloorPlan& plan, const RayCaster& caster, const Errand& errand) {
  Exploration result{{}, SeenFloor(plan), SeenFloor(plan)};
  PathSearch search(plan);
  std::vector<std::uint8_t> territory(static_cast<std::size_t>(plan.cells()), 0);
  const Point2 start = plan.centre(errand.start);
  const double first_heading = errand.heading.value_or(0.0);
  const Point2 ahead{std::cos(first_heading), std::sin(first_heading)};
  search.search(errand.start, errand.reach, [&](int cell, double) {
    const Point2 at = plan.centre(cell);
    const double along = (at.x - start.x) * ahead.x + (at.y - start.y) * ahead.y;
    territory[static_cast<std::size_t>(cell)] = !errand.heading || along >= 0.0 ? 1 : 0;
    return false;
  });

  const auto look_around = [&](const SE2& from) {
    const RangeFinder& sensor = errand.sensor;
    const double eyes = kEyesShare * sensor.range;
    result.seen.look(caster, from, eyes, eyes, 2.0 * std::numbers::pi);
    result.drawn.look(caster, from, sensor.range, sensor.cleared_share * sensor.range, sensor.field_of_view);
  };
  int here = errand.start;
  double way = 0.0, since_look = 0.0, since_scan = 0.0;
  result.poses.push_back({start.x, start.y, first_heading});
  look_around(result.poses.back());
  while (way < errand.longest_way) {
    const int goal = search.search(here, 4.0 * errand.reach + 1.0, [&](int cell, double) {
      return territory[static_cast<std::size_t>(cell)] != 0 && !result.seen.has_seen(cell);
    });
    if (goal < 0) break;
    const std::vector<Point2> path = search.path_to(goal);
    for (std::size_t i = 1; i < path.size() && way < errand.longest_way; ++i) {
      throw_if_cancelled();
      const Point2 d{path[i].x - path[i - 1].x, path[i].y - path[i - 1].y};
      const double step = std::hypot(d.x, d.y);
      const double heading = std::atan2(d.y, d.x);
      way += step;
      since_look += step;
      since_scan += step;
      here = plan.cell_at(path[i]);
      const double turn = std::abs(normalize_angle(heading - result.poses.back().theta));
      if (since_scan >= errand.scan_every || turn > kSharpTurn) {
        result.poses.push_back({path[i].x, path[i].y, heading});
        since_scan = 0.0;
      }
      if (since_look < kLookEvery && i + 1 < path.size()) continue;
      since_look = 0.0;
      look_around({path[i].x, path[i].y, heading});
      if (result.seen.has_seen(goal)) break;
    }
    // A goal that cannot be seen from itself (its raster cell straddles a wall) must not be sought for ever.
    if (here == goal && !result.seen.has_seen(goal)) territory[static_cast<std::size_t>(goal)] = 0;
  }
  return result;
}

}  // namespace gridmerge::internal
