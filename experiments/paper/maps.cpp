// SPDX-License-Identifier: Apache-2.0
#include "maps.hpp"

#include <fmt/format.h>

#include <cmath>
#include <span>
#include <stdexcept>

#include "building.hpp"
#include "gridmerge/grid/resample.hpp"
#include "simulate/random.hpp"

namespace gridmerge::paper {

using namespace internal;

namespace {

constexpr double kExtent = 100.0;      // of a map [m]
constexpr double kMiddleOfWay = 38.0;  // the way through the hall from west to east: its y [m]

/// A laser as the paper's robots carry: half of the surroundings, in steps of a degree.
SimulateOptions mapping_options(int side, std::uint64_t seed) {
  constexpr double kDegree = 0.017453292519943295;
  SimulateOptions options;
  options.sensor.field_of_view = 180.0 * kDegree;
  options.sensor.angular_step = 0.5 * kDegree;
  options.sensor.range = 20.0;
  options.drift = 0.05;
  options.clutter = 0.0;
  options.resolution = kExtent / side;
  options.seed = seed;
  return options;
}

/// The same map on side x side cells about the middle of what it knows.
RobotMap centred(const SimulatedMap& robot, int side) {
  const OccupancyGrid known = crop_to_known(robot.grid);
  if (known.width > side || known.height > side)
    throw std::runtime_error("a robot's map is larger than the experiment's");
  const int left = (side - known.width) / 2, below = (side - known.height) / 2;
  const double cell = known.resolution;
  RobotMap result{make_grid(side, side, cell, known.origin * SE2{-left * cell, -below * cell, 0.0}),
                  robot.T_building_map};
  for (int row = 0; row < known.height; ++row) {
    for (int column = 0; column < known.width; ++column)
      result.map.at(left + column, below + row) = known.at(column, row);
  }
  return result;
}

/// As much of a way as `length` metres of it.
std::vector<Point2> first_part(std::span<const Point2> way, double length) {
  std::vector<Point2> part{way.front()};
  for (std::size_t i = 1; i < way.size() && length > 0.0; ++i) {
    const Point2 d{way[i].x - way[i - 1].x, way[i].y - way[i - 1].y};
    const double step = std::hypot(d.x, d.y);
    const double share = std::min(1.0, length / step);
    part.push_back({way[i - 1].x + share * d.x, way[i - 1].y + share * d.y});
    length -= step;
  }
  return part;
}

class Expedition {
 public:
  Expedition(const Building& building, int side, std::uint64_t seed)
      : building_(building), side_(side), seed_(seed) {}

  /// The map of the robot of this number that goes this way.
  RobotMap go(int robot, std::span<const Point2> way) const {
    const std::uint64_t seed = seed_ * 1000 + static_cast<std::uint64_t>(robot);
    return centred(simulate_way(building_, way, mapping_options(side_, seed)), side_);
  }

 private:
  const Building& building_;
  int side_;
  std::uint64_t seed_;
};

/// Where a growing function reaches `wanted`, by bisection.
template <typename Function>
double where_reached(double low, double high, double wanted, const Function& function) {
  constexpr int kRounds = 12;
  for (int round = 0; round < kRounds; ++round) {
    const double middle = 0.5 * (low + high);
    (function(middle) < wanted ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

/// m3 and m4. m3 goes west to the corridor's end. How far apart the two start decides what they share; how
/// far m4 goes decides which part of its map that is.
std::pair<RobotMap, RobotMap> part_back_to_back(const Expedition& expedition, Random& random) {
  const double line = random.uniform(50.0, 53.0);  // both start near it
  const double end = random.uniform(5.0, 8.0);
  const auto go_west = [&](double apart) {
    const std::vector<Point2> way{{line + 0.5 * apart, kMiddleOfWay}, {36.0, 37.5}, {end, 37.5}};
    return expedition.go(3, way);
  };
  const auto go_east = [&](double apart, double length) {
    const std::vector<Point2> way{{line - 0.5 * apart, kMiddleOfWay}, {60.0, 38.5}, {90.0, 38.5}};
    return expedition.go(4, first_part(way, length));
  };
  const auto shared = [](const RobotMap& m3, const RobotMap& m4) { return measure_shared({"", &m3, &m4}); };
  constexpr double kSomeWay = 12.0;  // [m]
  const double apart = where_reached(0.0, 5.0, kShareOfM3, [&](double metres) {
    return shared(go_west(metres), go_east(metres, kSomeWay)).of_fixed;
  });
  const RobotMap m3 = go_west(apart);
  // The farther m4 goes, the smaller its share.
  const double length = where_reached(
      0.5, 40.0, -kShareOfM4, [&](double metres) { return -shared(m3, go_east(apart, metres)).of_moving; });
  std::pair<RobotMap, RobotMap> maps{m3, go_east(apart, length)};
  const SharedCells result = shared(maps.first, maps.second);
  if (std::abs(result.of_fixed - kShareOfM3) > 0.003 || std::abs(result.of_moving - kShareOfM4) > 0.008)
    throw std::runtime_error("the shares that m3 and m4 are to have cannot be had");
  return maps;
}

}  // namespace

Draw make_draw(int side, std::uint64_t seed) {
  Draw draw{seed, make_entrance(seed), {}};
  const Expedition expedition(draw.building, side, seed);
  Random random(seed + 7);
  const auto near = [&](double x, double y) {
    const double dx = random.uniform(-0.4, 0.4);
    return Point2{x + dx, y + random.uniform(-0.4, 0.4)};
  };
  const std::vector<std::vector<Point2>> ways{
      {near(16, 37.5), near(37, 37.7), near(46, 38.5), near(46, 62)},
      {near(46, 70), near(46, 40), near(38, 38), near(22, 37.5)},
      {near(46, 76), near(46, 42), near(40, 38)},
      {near(46, 56), near(46, 40), near(40, 38), near(14, 37.5)},
      {near(24, 37.5), near(38, 37.7), near(50, 38), near(70, 38.5)},
      {near(88, 38.5), near(60, 38.5), near(46.5, 39), near(46, 58)},
  };
  auto [m3, m4] = part_back_to_back(expedition, random);
  draw.robots.push_back(expedition.go(1, ways[0]));
  draw.robots.push_back(expedition.go(2, ways[1]));
  draw.robots.push_back(std::move(m3));
  draw.robots.push_back(std::move(m4));
  for (int robot = 5; robot <= 8; ++robot)
    draw.robots.push_back(expedition.go(robot, ways[static_cast<std::size_t>(robot) - 3]));
  return draw;
}

Pair pair_of(const Draw& draw, std::size_t fixed, std::size_t moving) {
  return {fmt::format("m{} + m{}", fixed, moving), &draw.robots.at(fixed - 1), &draw.robots.at(moving - 1)};
}

SharedCells measure_shared(const Pair& pair) {
  // On the moving map's lattice, since that map is the smaller one where shares are to be exact.
  SimilarityMeter meter(pair.moving->map, pair.fixed->map);
  SharedCells shared{meter.count_common(inverse(pair.truth()))};
  const CommonClasses& common = shared.common;
  const auto all = static_cast<double>(common.occupied_occupied + common.free_free + common.contradicting);
  shared.of_fixed = all / static_cast<double>(count_cells(pair.fixed->map).known());
  shared.of_moving = all / static_cast<double>(count_cells(pair.moving->map).known());
  return shared;
}

}  // namespace gridmerge::paper
