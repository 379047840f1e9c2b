// SPDX-License-Identifier: Apache-2.0
#include "evaluate/dataset.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "gridmerge/evaluate/evaluate.hpp"
#include "io/add_map.hpp"

namespace gridmerge::internal {

namespace {

namespace fs = std::filesystem;

constexpr const char* kBuilding = "building.yaml";

TruthMap robot_map(std::size_t robot) {
  return {fmt::format("robot_{}.yaml", robot + 1), {}};
}

TruthMap elsewhere_map(std::size_t map) {
  return {fmt::format("elsewhere_{}.yaml", map + 1), {}};
}

std::vector<TruePair> true_pairs(const Simulation& simulation) {
  std::vector<TruePair> pairs;
  for (const SimulatedPair& pair : simulation.pairs) {
    pairs.push_back({robot_map(pair.fixed), robot_map(pair.moving), pair.T_fixed_moving, pair.tolerance,
                     std::string(1, pair.tier), pair.overlap, pair.shared_wall});
  }
  return pairs;
}

/// Each robot's map on the building as it is drawn.
std::vector<TruePair> on_building(const Simulation& simulation) {
  std::vector<TruePair> pairs;
  for (std::size_t robot = 0; robot < simulation.maps.size(); ++robot) {
    const SimulatedMap& map = simulation.maps[robot];
    pairs.push_back({{kBuilding, {}},
                     robot_map(robot),
                     map.T_building_map,
                     std::max(kMinTolerance, 0.3 + 2.0 * map.bend),
                     "A",
                     1.0,
                     0.0});
  }
  return pairs;
}

std::vector<NegativePair> negatives(const Simulation& simulation, std::size_t others) {
  std::vector<NegativePair> pairs;
  for (const auto& [a, b] : simulation.strangers) pairs.push_back({robot_map(a), robot_map(b)});
  for (std::size_t robot = 0; robot < simulation.maps.size(); ++robot) {
    for (std::size_t other = 0; other < others; ++other)
      pairs.push_back({robot_map(robot), elsewhere_map(other)});
  }
  return pairs;
}

/// All robots' maps, relative to the first.
std::vector<TrueSet> sets(const Simulation& simulation) {
  if (simulation.maps.size() < 2) return {};
  TrueSet set{"building", {}};
  const SimulatedMap& first = simulation.maps.front();
  for (std::size_t robot = 0; robot < simulation.maps.size(); ++robot) {
    const SimulatedMap& map = simulation.maps[robot];
    set.members.push_back({robot_map(robot), inverse(first.T_building_map) * map.T_building_map,
                           std::max(kMinTolerance, 0.3 + 2.0 * (first.bend + map.bend))});
  }
  return {set};
}

}  // namespace

void write_dataset(const fs::path& directory, const Simulation& simulation,
                   const std::vector<Simulation>& elsewhere, const DatasetOptions& options) {
  FileSet files(directory, FileSet::IfMissing::make);
  const auto add = [&](const OccupancyGrid& grid, const std::string& name, bool probabilities) {
    probabilities ? add_probability_map(files, grid, name) : add_map(files, grid, name);
  };
  for (std::size_t i = 0; i < simulation.maps.size(); ++i) {
    const SimulatedMap& map = simulation.maps[i];
    add(map.grid, robot_map(i).name, options.probabilities);
    for (std::size_t step = 0; step < map.earlier.size(); ++step)
      add(map.earlier[step], fmt::format("robot_{}_step_{}.yaml", i + 1, step + 1), options.probabilities);
  }
  std::size_t others = 0;
  for (const Simulation& other : elsewhere) {
    for (const SimulatedMap& map : other.maps)
      add(map.grid, elsewhere_map(others++).name, options.probabilities);
  }
  add(draw_building(simulation.building, 0.05), kBuilding, false);
  files.add("pairs.tsv", format_pairs(true_pairs(simulation)));
  files.add("building.tsv", format_pairs(on_building(simulation)));
  files.add("negatives.tsv", format_negatives(negatives(simulation, others)));
  files.add("sets.tsv", format_sets(sets(simulation)));
  files.commit();
}

}  // namespace gridmerge::internal
