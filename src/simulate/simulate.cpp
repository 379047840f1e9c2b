// SPDX-License-Identifier: Apache-2.0
#include "gridmerge/simulate/simulate.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <string>
#include <utility>

#include "grid/parallel.hpp"
#include "gridmerge/grid/execution.hpp"
#include "simulate/surroundings.hpp"
#include "simulate/survey.hpp"
#include "simulate/team.hpp"

namespace gridmerge {

using namespace internal;

namespace {

void require(bool condition, const char* what) {
  if (!condition) throw std::invalid_argument(what);
}

bool is_between(double value, double low, double high) {
  return value >= low && value <= high;
}

/// How one robot maps.
void validate_mapping(const SimulateOptions& options) {
  validate(options.sensor);
  require(is_between(options.robot_radius, 0.05, 5.0), "a robot's radius must be between 0.05 and 5 metres");
  require(is_between(options.scan_every, 0.02, 10.0), "scans must be between 0.02 and 10 metres apart");
  require(is_between(options.drift, 0.0, 10.0), "drift must be between 0 and 10");
  require(is_between(options.clutter, 0.0, 10.0), "clutter must be between 0 and 10");
  require(is_between(options.resolution, 0.01, 1.0),
          "the resolution must be between 0.01 and 1 metres per cell");
  require(options.steps >= 1 && options.steps <= 1000, "there must be between 1 and 1000 steps");
  require(!options.tidy || is_between(*options.tidy, 0.0, 1.0), "walls can be made thicker by 0 to 1 metres");
}

/// Fills in how much wall of the moving map lies where the fixed one knows, and the tier, which also asks
/// how much of it meets wall there.
void measure_shared_wall(const OccupancyGrid& fixed, const OccupancyGrid& moving, double bend,
                         SimulatedPair& pair) {
  constexpr double kNear = 0.1;  // [m]
  const int reach = static_cast<int>(std::ceil((kNear + bend) / fixed.resolution));
  const ManyPointsTransform T_map_grid(moving.origin);
  const ManyPointsTransform T_grid_moving(inverse(fixed.origin) * pair.T_fixed_moving);
  int shared = 0, matching = 0;
  for (int row = 0; row < moving.height; ++row) {
    for (int column = 0; column < moving.width; ++column) {
      if (moving.at(column, row) != Cell::occupied) continue;
      const Point2 p = T_grid_moving * (T_map_grid * Point2{(column + 0.5) * moving.resolution,
                                                            (row + 0.5) * moving.resolution});
      const int x = static_cast<int>(std::floor(p.x / fixed.resolution));
      const int y = static_cast<int>(std::floor(p.y / fixed.resolution));
      if (!fixed.contains(x, y) || fixed.at(x, y) == Cell::unknown) continue;
      ++shared;
      bool meets = false;
      for (int dy = -reach; dy <= reach && !meets; ++dy) {
        for (int dx = -reach; dx <= reach && !meets; ++dx)
          meets = fixed.contains(x + dx, y + dy) && fixed.at(x + dx, y + dy) == Cell::occupied;
      }
      matching += meets ? 1 : 0;
    }
  }
  pair.shared_wall = shared * moving.resolution;
  const double walls = pair.shared_wall / 0.05;
  const double match = shared > 0 ? static_cast<double>(matching) / shared : 0.0;
  pair.tier = walls >= 400.0 && match >= 0.8 ? 'A' : walls >= 150.0 && match >= 0.6 ? 'B' : 'C';
}

/// Root mean square distance between where two transforms put a map's places [m].
double difference(const DrawnPlaces& places, const SE2& a, const SE2& b) {
  double sum = 0.0;
  const std::vector<PointPair> all = places.building_and_map();
  const ManyPointsTransform T_a(a), T_b(b);
  for (const PointPair& place : all) {
    const Point2 at_a = T_a * place.in_b, at_b = T_b * place.in_b;
    sum += (at_a.x - at_b.x) * (at_a.x - at_b.x) + (at_a.y - at_b.y) * (at_a.y - at_b.y);
  }
  return all.empty() ? 0.0 : std::sqrt(sum / static_cast<double>(all.size()));
}

SimulatedPair make_pair(const std::vector<Survey>& surveys, std::size_t fixed, std::size_t moving,
                        const std::vector<PointPair>& common) {
  const Survey &f = surveys[fixed], &m = surveys[moving];
  const RigidFit fit = fit_rigid(common);
  SimulatedPair pair{fixed, moving, fit.T_a_b};
  // Bent maps have a transform for what they share and another one for all of them; an estimate may be
  // nearer to either.
  const double doubt = difference(m.places, fit.T_a_b, inverse(f.map.T_building_map) * m.map.T_building_map);
  pair.tolerance = std::max(kMinTolerance, 0.3 + 2.0 * fit.rms + doubt);
  pair.overlap =
      static_cast<double>(common.size()) / std::max(1, std::min(f.places.count(), m.places.count()));
  measure_shared_wall(f.map.grid, m.map.grid, fit.rms, pair);
  return pair;
}

void list_pairs(const std::vector<Survey>& surveys, Simulation& simulation) {
  constexpr double kMinShared = 1.0;  // [m^2]: less is next to nothing, but not nothing
  std::vector<double> largest(surveys.size(), 0.0);
  for (std::size_t i = 0; i < surveys.size(); ++i) {
    for (std::size_t k = i + 1; k < surveys.size(); ++k) {
      const std::vector<PointPair> common = common_places(surveys[i].places, surveys[k].places);
      if (common.empty()) simulation.strangers.emplace_back(i, k);
      if (static_cast<double>(common.size()) * DrawnPlaces::kCell * DrawnPlaces::kCell < kMinShared) continue;
      simulation.pairs.push_back(make_pair(surveys, i, k, common));
      for (const std::size_t map : {i, k})
        largest[map] = std::max(largest[map], simulation.pairs.back().overlap);
    }
  }
  for (const double overlap : largest) simulation.overlap += overlap / static_cast<double>(surveys.size());
}

Simulation send_team(const SimulateOptions& options, const Building& building, const Team& team,
                     Random random) {
  std::vector<Random> chances;
  chances.reserve(team.errands.size());
  for (std::size_t i = 0; i < team.errands.size(); ++i) chances.push_back(random.fork());
  std::vector<std::optional<Survey>> made(team.errands.size());
  parallel_for(made.size(), [&](std::size_t i) {
    const Visit& visit = team.visits[i];
    made[i] = survey(options, building, visit, explore(visit.plan, visit.caster, team.errands[i]).poses,
                     chances[i]);
  });
  std::vector<Survey> surveys;
  surveys.reserve(made.size());
  for (std::optional<Survey>& one : made) surveys.push_back(std::move(*one));
  Simulation simulation;
  list_pairs(surveys, simulation);
  for (Survey& one : surveys) simulation.maps.push_back(std::move(one.map));
  return simulation;
}

/// Plans with an idea of what robots will draw, and sends them; where the overlap comes out otherwise than it
/// was planned, plans again for as much more or less, from the same starts. The nearest of all tries.
Simulation aim_for_overlap(const SimulateOptions& options, const Building& building, const FloorPlan& plan,
                           const Random& random) {
  constexpr int kTries = 4;
  constexpr double kNearEnough = 0.03;
  const double wanted = *options.overlap;
  SimulateOptions aim = options;
  std::optional<Simulation> best;
  const auto off = [&](const Simulation& simulation) { return std::abs(simulation.overlap - wanted); };
  for (int i = 0; i < kTries; ++i) {
    Random chance = random;
    Simulation simulation;
    try {
      const Team team = plan_team(aim, building, plan, chance);
      simulation = send_team(options, building, team, chance);
    } catch (const std::invalid_argument&) {
      if (!best) throw;
      break;  // what is aimed for instead cannot be had
    }
    aim.overlap = std::clamp(*aim.overlap + wanted - simulation.overlap, 0.01, 1.0);
    if (!best || off(simulation) < off(*best)) best = std::move(simulation);
    if (off(*best) <= kNearEnough || wanted == 0.0) break;
  }
  return std::move(*best);
}

Simulation send_until_overlap(const SimulateOptions& options, const Building& building, const FloorPlan& plan,
                              Random& random) {
  const int rounds = options.starts.empty() ? 4 : 1;  // other starts
  double nearest = std::numeric_limits<double>::infinity();
  for (int i = 0; i < rounds; ++i) {
    Simulation simulation = aim_for_overlap(options, building, plan, random.fork());
    if (is_near_enough(simulation.overlap, *options.overlap)) return simulation;
    if (std::abs(simulation.overlap - *options.overlap) < std::abs(nearest - *options.overlap))
      nearest = simulation.overlap;
    if (options.progress) options.progress((i + 1.0) / (rounds + 1.0));
  }
  throw no_such_overlap(*options.overlap, nearest);
}

Simulation simulate_in_arena(const SimulateOptions& options) {
  Random random(options.seed);
  Building building = make_building(options.kind, options.width, options.height, random.bits());
  const FloorPlan plan(building.edges, options.robot_radius);
  require(plan.count_free() > 0, "no robot of this radius can stand in the building");
  Simulation simulation;
  if (options.overlap) {
    simulation = send_until_overlap(options, building, plan, random);
  } else {
    const Team team = plan_team(options, building, plan, random);
    simulation = send_team(options, building, team, random);
  }
  simulation.building = std::move(building);
  if (options.progress) options.progress(1.0);
  return simulation;
}

}  // namespace

void validate(const RangeFinder& sensor) {
  const auto is_share = [](double value) { return value >= 0.0 && value <= 1.0; };
  require(sensor.field_of_view > 0.0 && sensor.field_of_view <= 2.0 * std::numbers::pi + 1e-9,
          "the field of view must be between 0 and 360 degrees");
  require(sensor.angular_step >= 1e-4 && sensor.angular_step <= sensor.field_of_view,
          "the angular step must be 0.0001 rad (0.0058 degrees) at least, and not above the field of view");
  require(sensor.range >= 0.2 && sensor.range <= 200.0, "the range must be between 0.2 and 200 metres");
  require(sensor.noise >= 0.0 && sensor.noise <= 10.0, "the noise must be between 0 and 10 metres");
  require(is_share(sensor.stray_share) && is_share(sensor.missed_share) && is_share(sensor.cleared_share),
          "shares of beams must lie in [0, 1]");
}

void validate(const SimulateOptions& options) {
  validate_mapping(options);
  validate_sides(options.width, options.height);
  require(options.robots >= 1 && options.robots <= 1000, "there must be between 1 and 1000 robots");
  require(!options.overlap || is_between(*options.overlap, 0.0, 1.0), "overlap must lie in [0, 1]");
  require(!options.overlap || options.robots >= 2, "an overlap takes two robots");
  require(options.starts.empty() || options.starts.size() == static_cast<std::size_t>(options.robots),
          "there must be a start for every robot, or none");
  require(options.headings.empty() || options.headings.size() == static_cast<std::size_t>(options.robots),
          "there must be a heading for every robot, or none");
  for (const double heading : options.headings) require(std::isfinite(heading), "headings must be finite");
  require(is_between(options.longest_way, 0.0, 1e5), "the longest way must be between 0 and 100000 metres");
  require(options.threads >= 0, "threads must not be negative");
}

Simulation simulate(const SimulateOptions& options) {
  validate(options);
  Simulation simulation;
  with_threads(options.threads, [&] { simulation = simulate_in_arena(options); });
  return simulation;
}

SimulatedMap simulate_way(const Building& building, std::span<const Point2> way,
                          const SimulateOptions& options) {
  validate_mapping(options);
  validate(building);
  require(!way.empty(), "a way must have a point");
  for (const Point2& point : way)
    require(is_near(building, point), "a way must stay within 500 metres of the building");
  const FloorPlan plan(building.edges, options.robot_radius);
  const int start = plan.free_cell_near(way.front(), options.robot_radius);
  require(start >= 0, "no robot can stand where the way starts");
  const RayCaster walls(building.edges);
  std::vector<SE2> path;
  double heading = 0.0;
  for (std::size_t i = 1; i < way.size(); ++i) {
    const Point2 d{way[i].x - way[i - 1].x, way[i].y - way[i - 1].y};
    const double length = std::hypot(d.x, d.y);
    if (length == 0.0) continue;
    const Point2 along{d.x / length, d.y / length};
    require(std::isinf(walls.cast(way[i - 1], along, length).range), "the way goes through a wall");
    heading = std::atan2(d.y, d.x);
    const int scans = std::max(1, static_cast<int>(std::round(length / options.scan_every)));
    for (int scan = 0; scan < scans; ++scan) {
      const double at = scan * length / scans;
      path.push_back({way[i - 1].x + at * along.x, way[i - 1].y + at * along.y, heading});
    }
  }
  path.push_back({way.back().x, way.back().y, heading});
  Random random(options.seed);
  const Visit visit = make_visit(building.edges, plan, options.robot_radius, start, options.clutter, random);
  return survey(options, building, visit, std::move(path), random.fork()).map;
}

SimulateOptions elsewhere(SimulateOptions options, int number) {
  options.robots = 1;
  options.overlap.reset();
  options.starts.clear();
  options.headings.clear();
  options.seed = options.seed * 1000003 + static_cast<std::uint64_t>(number) + 1;
  return options;
}

}  // namespace gridmerge
