// SPDX-License-Identifier: Apache-2.0
// Simulated plans and the maps that belong on them or do not: what match() says of each hypothesis at its
// scale. calibration/fit_plans.py fits the scaled verdict to it.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include "gridmerge/grid/resample.hpp"
#include "gridmerge/match/match.hpp"
#include "gridmerge/simulate/simulate.hpp"
#include "match/scaled_pose.hpp"
#include "match/scaled_verdict.hpp"

namespace {

using namespace gridmerge;
using namespace gridmerge::internal;

constexpr std::array kKinds{BuildingKind::office,    BuildingKind::hall, BuildingKind::apartment,
                            BuildingKind::symmetric, BuildingKind::loop, BuildingKind::curved};
constexpr std::array kDrifts{0.5, 1.0, 2.0};
constexpr int kRobots = 2;
constexpr double kLargestThing = 2.5;  // [m]: what stands alone and is no larger is furniture
constexpr double kLargestScale = 1.7;  // of a plan, or its inverse

/// A plan shows no furniture.
void take_furniture_away(OccupancyGrid& plan) {
  std::vector<char> visited(plan.cells.size(), 0);
  std::vector<std::size_t> thing;
  for (std::size_t first = 0; first < plan.cells.size(); ++first) {
    if (plan.cells[first] != Cell::occupied || visited[first] != 0) continue;
    thing.assign(1, first);
    visited[first] = 1;
    int left = plan.width, right = 0, bottom = plan.height, top = 0;
    for (std::size_t i = 0; i < thing.size(); ++i) {
      const int x = static_cast<int>(thing[i] % plan.width), y = static_cast<int>(thing[i] / plan.width);
      left = std::min(left, x);
      right = std::max(right, x);
      bottom = std::min(bottom, y);
      top = std::max(top, y);
      for (int next_y = std::max(0, y - 1); next_y <= std::min(plan.height - 1, y + 1); ++next_y) {
        for (int next_x = std::max(0, x - 1); next_x <= std::min(plan.width - 1, x + 1); ++next_x) {
          const std::size_t next = plan.index(next_x, next_y);
          if (visited[next] != 0 || plan.cells[next] != Cell::occupied) continue;
          visited[next] = 1;
          thing.push_back(next);
        }
      }
    }
    if (std::hypot(right - left, top - bottom) * plan.resolution > kLargestThing) continue;
    for (int y = bottom; y <= top; ++y) {
      for (int x = left; x <= right; ++x) plan.at(x, y) = Cell::free;
    }
  }
}

/// A building's plan at a scale and a turn of its own, and its robots' maps.
struct Case {
  Simulation simulation;
  OccupancyGrid plan;
  double scale = 1.0;
  double turn = 0.0;
};

Case make_case(int number) {
  std::mt19937 random(static_cast<unsigned>(number) * 7919U + 13U);
  const auto uniform = [&](double least, double most) {
    return least + (most - least) * static_cast<double>(random()) / 4294967296.0;  // the same everywhere
  };
  SimulateOptions options;
  options.kind = kKinds[static_cast<std::size_t>(number) % kKinds.size()];
  const bool is_small = options.kind == BuildingKind::apartment;
  options.width = is_small ? uniform(14.0, 26.0) : uniform(25.0, 65.0);
  options.height = is_small ? uniform(10.0, 18.0) : uniform(18.0, 40.0);
  options.robots = kRobots;
  options.drift = kDrifts[static_cast<std::size_t>(number) / kKinds.size() % kDrifts.size()];
  options.clutter = uniform(0.5, 1.5);
  options.sensor.range = uniform(5.0, 10.0);
  options.longest_way = uniform(0.6, 2.6) * (options.width + options.height);
  options.seed = 1000U + static_cast<unsigned>(number);
  Case made;
  made.scale = std::exp(uniform(-1.0, 1.0) * std::log(kLargestScale));
  made.turn = uniform(0.0, 6.28);
  made.simulation = simulate(options);
  OccupancyGrid drawn = draw_building(made.simulation.building, 0.05);
  take_furniture_away(drawn);
  made.plan = scaled(transform_grid(drawn, {0.0, 0.0, made.turn}, 0.05 / made.scale), made.scale);
  return made;
}

/// Root mean square distance [m of the map] between where two poses put a map's walls.
double distance(const OccupancyGrid& map, const ScaledPose& a, const ScaledPose& b, double scale) {
  double sum = 0.0, count = 0.0;
  for (int row = 0; row < map.height; ++row) {
    for (int column = 0; column < map.width; ++column) {
      if (map.at(column, row) != Cell::occupied) continue;
      const Point2 p = map.origin * Point2{(column + 0.5) * map.resolution, (row + 0.5) * map.resolution};
      const Point2 at_a = a * p, at_b = b * p;
      sum += std::pow(at_a.x - at_b.x, 2) + std::pow(at_a.y - at_b.y, 2);
      count += 1.0;
    }
  }
  return std::sqrt(sum / std::max(1.0, count)) / scale;
}

/// A row for each hypothesis, the best one first: with the terms of the model, which fit_plans.py weighs. The
/// error is in metres, or in parts of what the map is bent where that is more.
void print_match(const std::string& name, const OccupancyGrid& plan, const SimulatedMap& map,
                 const Case* own) {
  MatchOptions options;
  options.scales = ScaleRange{0.5, 2.0};
  options.max_hypotheses = 100;
  const MatchResult result = match(plan, map.grid, options);
  const VerdictModel model = scaled_model(1);
  for (std::size_t i = 0; i < result.hypotheses.size(); ++i) {
    const Hypothesis& one = result.hypotheses[i];
    double error = std::numeric_limits<double>::infinity(), scale_error = error;
    if (own != nullptr) {
      const SE2 T = SE2{0.0, 0.0, own->turn} * map.T_building_map;
      const ScaledPose truth{{own->scale * T.x, own->scale * T.y, T.theta}, own->scale};
      scale_error = std::abs(one.scale / own->scale - 1.0);
      error =
          distance(map.grid, truth, {one.T_fixed_moving, one.scale}, own->scale) / std::max(1.0, map.bend);
    }
    fmt::print("{}\t{}\t{:.4f}\t{:.3f}", name, one.scale, scale_error, error);
    for (const RankTerm& term : model.rank_terms) fmt::print("\t{:.5g}", term.value(one.figures));
    for (const VerdictTerm& term : model.terms) fmt::print("\t{:.5g}", term(one.figures));
    fmt::print("\n");
  }
  std::fflush(stdout);
}

int number_of(const char* text) {
  int number = 0;
  const char* const end = text + std::strlen(text);
  const auto [stop, error] = std::from_chars(text, end, number);
  if (error != std::errc() || stop != end || number < 0)
    throw std::invalid_argument(fmt::format("{} is not a whole number", text));
  return number;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    if (argc != 3) throw std::invalid_argument("usage: gridmerge_plan_cases FIRST LAST > plan_cases.tsv");
    const int first = number_of(argv[1]), last = number_of(argv[2]);
    fmt::print("case\tscale\tscale_error\terror");
    const VerdictModel model = scaled_model(1);
    for (const RankTerm& term : model.rank_terms) fmt::print("\trank: {}", term.name);
    for (const VerdictTerm& term : model.terms) fmt::print("\tterm: {}", term.name);
    fmt::print("\n");
    Case before = make_case(first + static_cast<int>(kKinds.size()) * 1000);
    for (int number = first; number <= last; ++number) {
      Case made = make_case(number);
      for (int robot = 0; robot < kRobots; ++robot) {
        const auto name = [&](const char* what) { return fmt::format("{}_{}_{}", what, number, robot); };
        print_match(name("own"), made.plan, made.simulation.maps[static_cast<std::size_t>(robot)], &made);
        print_match(name("other"), before.plan, made.simulation.maps[static_cast<std::size_t>(robot)],
                    nullptr);
      }
      before = std::move(made);
    }
    return EXIT_SUCCESS;
  } catch (const std::exception& error) {
    fmt::print(stderr, "gridmerge_plan_cases: {}\n", error.what());
    return EXIT_FAILURE;
  }
}
