// SPDX-License-Identifier: Apache-2.0
#include "mapping.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <iterator>
#include <limits>
#include <random>
#include <stdexcept>
#include <string>

#include "gridmerge/grid/resample.hpp"

namespace gridmerge::example {

namespace {

// The range finder: 270 degrees, a beam every half degree.
constexpr int kBeamsEachSide = 270;
constexpr double kMaxRange = 8.0;            // [m]
constexpr double kRangeNoise = 0.02;         // [m], standard deviation
constexpr double kLostShare = 0.02;          // of the beams
constexpr double kStrayShare = 0.002;        // of the beams: dust, and people walking by
constexpr double kClearedWithoutEcho = 4.0;  // [m] that a beam with no echo counts as free

// The robot: where it scans, and how well it knows where that is.
constexpr double kScanEvery = 0.3;        // [m] of path
constexpr double kPositionNoise = 0.015;  // [m], standard deviation
constexpr double kHeadingNoise = 0.005;   // [rad], standard deviation

// The map: log-odds of a cell for one beam that ends in it or passes through it, and what the sums mean.
constexpr int kCellsPerMeter = 20;
constexpr int kHalfWidth = 50 * kCellsPerMeter;  // the largest trip fits
constexpr float kHit = 0.85F;
constexpr float kMiss = -0.5F;
constexpr float kLowest = -4.0F;
constexpr float kHighest = 4.0F;
constexpr float kOccupiedFrom = 0.62F;  // probability 0.65
constexpr float kFreeBelow = -0.9F;     // probability 0.29: two beams

Point2 operator+(Point2 p, Point2 q) {
  return {p.x + q.x, p.y + q.y};
}
Point2 operator-(Point2 p, Point2 q) {
  return {p.x - q.x, p.y - q.y};
}
Point2 operator*(double s, Point2 p) {
  return {s * p.x, s * p.y};
}
double cross(Point2 p, Point2 q) {
  return p.x * q.y - p.y * q.x;
}
double norm(Point2 p) {
  return std::sqrt(p.x * p.x + p.y * p.y);
}
Point2 normalized(Point2 p) {
  return (1.0 / norm(p)) * p;
}
/// The direction `p` turned by the angle of the unit vector `by` (a product of complex numbers).
Point2 turned(Point2 p, Point2 by) {
  return {p.x * by.x - p.y * by.y, p.x * by.y + p.y * by.x};
}

/// Random numbers that every standard library draws alike: only the engine of <random> is the same
/// everywhere, its distributions are not.
class Chance {
 public:
  explicit Chance(std::uint64_t seed) : engine_(seed) {}

  double uniform() { return static_cast<double>(engine_() >> 11) * 0x1p-53; }

  /// Nearly normal: twelve uniform numbers have variance 1 together.
  double normal(double deviation) {
    double sum = -6.0;
    for (int i = 0; i < 12; ++i) sum += uniform();
    return deviation * sum;
  }

 private:
  std::mt19937_64 engine_;
};

/// A unit vector at `half_tangent` = tan(angle / 2).
Point2 unit_vector(double half_tangent) {
  const double square = half_tangent * half_tangent;
  return {(1.0 - square) / (1.0 + square), 2.0 * half_tangent / (1.0 + square)};
}

std::vector<Point2> beam_directions() {
  const Point2 step = unit_vector(0.00436335);  // half a degree
  std::vector<Point2> left{{1.0, 0.0}};
  for (int i = 0; i < kBeamsEachSide; ++i) left.push_back(turned(left.back(), step));
  std::vector<Point2> beams;
  for (std::size_t i = left.size(); i-- > 1;) beams.push_back({left[i].x, -left[i].y});
  beams.insert(beams.end(), left.begin(), left.end());
  return beams;
}

/// Distance along the unit vector `direction` to the edge; infinity when the ray misses it.
double distance_to(const Edge& edge, Point2 from, Point2 direction) {
  constexpr double kNever = std::numeric_limits<double>::infinity();
  const Point2 along = edge.b - edge.a;
  const double denominator = cross(direction, along);
  if (denominator == 0.0) return kNever;
  const Point2 offset = edge.a - from;
  const double distance = cross(offset, along) / denominator;
  const double share = cross(offset, direction) / denominator;
  return share >= 0.0 && share <= 1.0 ? distance : kNever;
}

struct Echo {
  double range = std::numeric_limits<double>::infinity();
  double probability = 1.0;
};

/// The nearest edge farther than `beyond`.
Echo nearest_echo(const Building& building, Point2 from, Point2 direction, double beyond) {
  Echo nearest;
  for (const Edge& edge : building) {
    const double distance = distance_to(edge, from, direction);
    if (distance > beyond && distance < nearest.range) nearest = {distance, edge.echo};
  }
  return nearest;
}

/// Where a beam ends, having passed what chance lets it pass; infinity when nothing stops it.
double beam_range(const Building& building, Point2 from, Point2 direction, Chance& chance) {
  Echo echo = nearest_echo(building, from, direction, 0.0);
  while (echo.probability < 1.0 && chance.uniform() >= echo.probability) {
    echo = nearest_echo(building, from, direction, echo.range);
  }
  return echo.range;
}

/// The edges that a beam from `from` can reach.
Building edges_nearby(const Building& building, Point2 from) {
  Building nearby;
  std::copy_if(building.begin(), building.end(), std::back_inserter(nearby), [&](const Edge& edge) {
    return std::min(edge.a.x, edge.b.x) <= from.x + kMaxRange &&
           std::max(edge.a.x, edge.b.x) >= from.x - kMaxRange &&
           std::min(edge.a.y, edge.b.y) <= from.y + kMaxRange &&
           std::max(edge.a.y, edge.b.y) >= from.y - kMaxRange;
  });
  return nearby;
}

/// A log-odds map in the robot's frame, its middle at (0, 0).
class LogOddsMap {
 public:
  LogOddsMap()
      : log_odds_(static_cast<std::size_t>(kSide) * kSide, std::numeric_limits<float>::quiet_NaN()) {}

  /// A beam from `from`: every cell on its way was free; where `ends_on_something`, its last cell was not.
  /// Metres.
  void add_beam(Point2 from, Point2 to, bool ends_on_something) {
    const Point2 start = static_cast<double>(kCellsPerMeter) * from;
    const Point2 end = static_cast<double>(kCellsPerMeter) * to;
    int column = cell_of(start.x);
    int row = cell_of(start.y);
    const int last_column = cell_of(end.x);
    const int last_row = cell_of(end.y);
    const Point2 way = end - start;
    // From cell to cell, each time over the border that the beam meets first.
    const int step_x = way.x < 0.0 ? -1 : 1;
    const int step_y = way.y < 0.0 ? -1 : 1;
    int crossings = std::abs(last_column - column) + std::abs(last_row - row);
    while (crossings-- > 0) {
      update(column, row, kMiss);
      const double until_x = column == last_column ? 2.0 : (column + (step_x > 0 ? 1 : 0) - start.x) / way.x;
      const double until_y = row == last_row ? 2.0 : (row + (step_y > 0 ? 1 : 0) - start.y) / way.y;
      if (until_x < until_y) {
        column += step_x;
      } else {
        row += step_y;
      }
    }
    update(last_column, last_row, ends_on_something ? kHit : kMiss);
  }

  OccupancyGrid thresholded() const {
    constexpr double kResolution = 1.0 / kCellsPerMeter;
    OccupancyGrid grid =
        make_grid(kSide, kSide, kResolution, {-kHalfWidth * kResolution, -kHalfWidth * kResolution, 0.0});
    for (std::size_t i = 0; i < log_odds_.size(); ++i) {
      if (log_odds_[i] > kOccupiedFrom) grid.cells[i] = Cell::occupied;
      if (log_odds_[i] < kFreeBelow) grid.cells[i] = Cell::free;
    }
    grid = crop_to_known(grid);
    // The corner lies on whole cells; its decimal places should say so.
    grid.origin.x = std::round(grid.origin.x * kCellsPerMeter) / kCellsPerMeter;
    grid.origin.y = std::round(grid.origin.y * kCellsPerMeter) / kCellsPerMeter;
    return grid;
  }

 private:
  static constexpr int kSide = 2 * kHalfWidth;

  static int cell_of(double coordinate) { return static_cast<int>(std::floor(coordinate)); }

  void update(int column, int row, float evidence) {
    float& cell = log_odds_[static_cast<std::size_t>(row + kHalfWidth) * kSide +
                            static_cast<std::size_t>(column + kHalfWidth)];
    cell = std::clamp((std::isnan(cell) ? 0.0F : cell) + evidence, kLowest, kHighest);
  }

  std::vector<float> log_odds_;
};

/// The poses in which the robot scans: evenly along each leg, and once after each turn.
std::vector<Pose> scan_poses(const Trip& trip) {
  std::vector<Pose> poses{start_pose(trip)};
  for (std::size_t i = 1; i < trip.stops.size(); ++i) {
    const Point2 leg = trip.stops[i] - trip.stops[i - 1];
    const Point2 heading = normalized(leg);
    const int scans = static_cast<int>(std::ceil(norm(leg) / kScanEvery));
    for (int k = 0; k <= scans; ++k) {
      poses.push_back({trip.stops[i - 1] + (static_cast<double>(k) / scans) * leg, heading});
    }
  }
  return poses;
}

void require_free_way(const Building& building, const Trip& trip) {
  for (std::size_t i = 1; i < trip.stops.size(); ++i) {
    const Point2 leg = trip.stops[i] - trip.stops[i - 1];
    if (nearest_echo(building, trip.stops[i - 1], normalized(leg), 0.0).range < norm(leg)) {
      throw std::invalid_argument("leg " + std::to_string(i) + " of the trip leads through a wall");
    }
  }
}

/// `pose` as seen from `frame`.
Pose relative_to(const Pose& frame, const Pose& pose) {
  const Point2 back{frame.heading.x, -frame.heading.y};
  return {turned(pose.position - frame.position, back), turned(pose.heading, back)};
}

/// One scan: taken at a pose of the building, drawn where the robot believes itself to be in its own map.
void add_scan(LogOddsMap& map, const Building& building, const Pose& pose_in_building,
              const Pose& believed_in_map, Chance& chance) {
  static const std::vector<Point2> beams = beam_directions();
  const Building nearby = edges_nearby(building, pose_in_building.position);
  for (const Point2& beam : beams) {
    double range =
        beam_range(nearby, pose_in_building.position, turned(beam, pose_in_building.heading), chance);
    if (chance.uniform() < kStrayShare) range = chance.uniform() * std::min(range, kMaxRange);
    if (chance.uniform() < kLostShare) continue;
    const bool hit = range <= kMaxRange;
    range = hit ? std::max(0.0, range + chance.normal(kRangeNoise)) : kClearedWithoutEcho;
    map.add_beam(believed_in_map.position,
                 believed_in_map.position + range * turned(beam, believed_in_map.heading), hit);
  }
}

}  // namespace

Pose start_pose(const Trip& trip) {
  return {trip.stops.front(), normalized(trip.first_heading)};
}

OccupancyGrid map_building(const Building& building, const Trip& trip) {
  require_free_way(building, trip);
  const Pose frame = start_pose(trip);
  Chance chance(trip.seed);
  LogOddsMap map;
  for (const Pose& pose : scan_poses(trip)) {
    Pose believed = relative_to(frame, pose);
    believed.position =
        believed.position + Point2{chance.normal(kPositionNoise), chance.normal(kPositionNoise)};
    believed.heading = turned(believed.heading, unit_vector(chance.normal(kHeadingNoise) / 2.0));
    add_scan(map, building, pose, believed, chance);
  }
  return map.thresholded();
}

}  // namespace gridmerge::example
