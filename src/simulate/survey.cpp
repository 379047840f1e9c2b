// SPDX-License-Identifier: Apache-2.0
#include "simulate/survey.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "gridmerge/grid/execution.hpp"
#include "simulate/drift.hpp"
#include "simulate/mapper.hpp"
#include "simulate/tidy.hpp"
#include "simulate/visit.hpp"

namespace gridmerge::internal {

namespace {

constexpr double kPlaceEvery = 0.5;  // along a beam [m]

/// One beam: how far it seems to go, and whether it seems to end on something.
struct Beam {
  double range;
  bool hits;
};

class Scanner {
 public:
  Scanner(const RangeFinder& sensor, const RayCaster& caster, const Walkers& walkers, Random& random)
      : sensor_(sensor), caster_(caster), walkers_(walkers), random_(random) {}

  Beam beam(Point2 from, Point2 direction) {
    double range =
        std::min(first_echo(from, direction), walkers_.distance_to(from, direction, sensor_.range));
    if (random_.chance(sensor_.stray_share)) range = random_.uniform() * std::min(range, sensor_.range);
    const bool hits = range <= sensor_.range && !random_.chance(sensor_.missed_share);
    if (!hits) return {sensor_.cleared_share * std::min(range, sensor_.range), false};
    return {std::max(0.0, range + random_.normal(sensor_.noise)), true};
  }

 private:
  /// Goes on through glass that does not reflect.
  double first_echo(Point2 from, Point2 direction) {
    double beyond = 0.0;
    while (true) {
      const Hit hit = caster_.cast(from, direction, sensor_.range, beyond);
      if (std::isinf(hit.range) || hit.echo >= 1.0 || random_.chance(hit.echo)) return hit.range;
      beyond = hit.range;
    }
  }

  const RangeFinder& sensor_;
  const RayCaster& caster_;
  const Walkers& walkers_;
  Random& random_;
};

/// What beams from these places may reach [m]: a range is measured too long by so many standard deviations
/// next to never.
Box reach_from(const std::vector<SE2>& places, const RangeFinder& sensor) {
  constexpr double kMostSigmas = 6.0;
  const double farthest = sensor.range + kMostSigmas * sensor.noise;
  Box reach;
  for (const SE2& place : places) {
    reach.add(Point2{place.x - farthest, place.y - farthest});
    reach.add(Point2{place.x + farthest, place.y + farthest});
  }
  return reach;
}

}  // namespace

DrawnPlaces::DrawnPlaces(double width, double height, double margin)
    : margin_(margin),
      width_(static_cast<int>((width + 2.0 * margin) / kCell) + 1),
      height_(static_cast<int>((height + 2.0 * margin) / kCell) + 1),
      sums_(static_cast<std::size_t>(width_) * height_) {}

void DrawnPlaces::add(Point2 in_building, Point2 in_map) {
  const double column = std::floor((in_building.x + margin_) / kCell);
  const double row = std::floor((in_building.y + margin_) / kCell);
  if (column < 0.0 || row < 0.0 || column >= width_ || row >= height_) return;
  Sum& sum = sums_[static_cast<std::size_t>(row) * width_ + static_cast<std::size_t>(column)];
  sum.building_x += in_building.x;
  sum.building_y += in_building.y;
  sum.x += in_map.x;
  sum.y += in_map.y;
  ++sum.count;
}

int DrawnPlaces::count() const {
  return static_cast<int>(
      std::count_if(sums_.begin(), sums_.end(), [&](const Sum& sum) { return is_drawn(sum); }));
}

std::vector<PointPair> DrawnPlaces::building_and_map() const {
  std::vector<PointPair> places;
  for (const Sum& sum : sums_) {
    if (!is_drawn(sum)) continue;
    const double n = sum.count;
    places.push_back({{sum.building_x / n, sum.building_y / n}, {sum.x / n, sum.y / n}});
  }
  return places;
}

std::vector<PointPair> common_places(const DrawnPlaces& a, const DrawnPlaces& b) {
  std::vector<PointPair> places;
  for (std::size_t i = 0; i < a.sums_.size(); ++i) {
    const DrawnPlaces::Sum &in_a = a.sums_[i], &in_b = b.sums_[i];
    if (!a.is_drawn(in_a) || !b.is_drawn(in_b)) continue;
    places.push_back(
        {{in_a.x / in_a.count, in_a.y / in_a.count}, {in_b.x / in_b.count, in_b.y / in_b.count}});
  }
  return places;
}

Survey survey(const SimulateOptions& options, const Building& building, const Visit& visit,
              std::vector<SE2> path, Random random) {
  Survey result{{}, DrawnPlaces(building.width, building.height, options.sensor.range)};
  SE2 frame = path.front();
  frame.theta = random.uniform(-std::numbers::pi, std::numbers::pi);
  const SE2 T_map_building = inverse(frame);
  DriftingPose belief(options.drift, random.fork());
  Walkers walkers(visit.plan, options.clutter, random.fork());
  Random noise = random.fork();
  Scanner scanner(options.sensor, visit.caster, walkers, noise);
  std::vector<SE2> T_map_robot;  // as the robot believes
  for (const SE2& pose : path) T_map_robot.push_back(T_map_building * belief.follow(pose));
  Mapper mapper(options.resolution, reach_from(T_map_robot, options.sensor));
  const int beams = static_cast<int>(options.sensor.field_of_view / options.sensor.angular_step) + 1;
  std::vector<Point2> directions;  // of the beams, in the robot's frame
  for (int i = 0; i < beams; ++i) {
    const double angle = -0.5 * options.sensor.field_of_view + i * options.sensor.angular_step;
    directions.push_back({std::cos(angle), std::sin(angle)});
  }
  const auto drawn = [&] { return options.tidy ? tidied(mapper.grid(), *options.tidy) : mapper.grid(); };
  for (std::size_t scan = 0; scan < path.size(); ++scan) {
    throw_if_cancelled();
    const SE2& pose = path[scan];
    const SE2& believed = T_map_robot[scan];
    const ManyPointsTransform to_building(pose), to_map(believed);
    const double c = std::cos(pose.theta), s = std::sin(pose.theta);
    for (const Point2& u : directions) {
      const Beam beam = scanner.beam({pose.x, pose.y}, {c * u.x - s * u.y, s * u.x + c * u.y});
      mapper.add_beam({believed.x, believed.y}, to_map * Point2{beam.range * u.x, beam.range * u.y},
                      beam.hits);
      for (double at = beam.range; at > 0.0; at -= kPlaceEvery) {
        const Point2 place{at * u.x, at * u.y};
        result.places.add(to_building * place, to_map * place);
      }
    }
    walkers.walk();
    // A short way has several moments at one scan.
    const auto steps = static_cast<std::size_t>(options.steps);
    while (result.map.earlier.size() + 1 < steps &&
           (scan + 1) * steps >= (result.map.earlier.size() + 1) * path.size())
      result.map.earlier.push_back(drawn());
  }
  result.map.grid = drawn();
  const RigidFit fit = fit_rigid(result.places.building_and_map());
  result.map.T_building_map = fit.T_a_b;
  result.map.bend = fit.rms;
  result.map.path = std::move(path);
  return result;
}

}  // namespace gridmerge::internal
