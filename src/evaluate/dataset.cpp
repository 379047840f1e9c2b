// SPDX-License-Identifier: Apache-2.0
#include "evaluate/dataset.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <string>
#include <string_view>
#include <system_error>

#include "gridmerge/evaluate/evaluate.hpp"
#include "gridmerge/io/file_error.hpp"
#include "io/add_map.hpp"
#include "io/destination.hpp"
#include "io/directory_lock.hpp"
#include "io/directory_names.hpp"

namespace gridmerge::internal {

namespace {

namespace fs = std::filesystem;

constexpr const char* kBuilding = "building.yaml";
constexpr const char* kPairs = "pairs.tsv";
constexpr const char* kOnBuilding = "building.tsv";
constexpr const char* kNegatives = "negatives.tsv";
constexpr const char* kSets = "sets.tsv";

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

/// The maps that the tables of an earlier dataset name.
std::set<std::string> maps_of_tables(const fs::path& directory) {
  std::set<std::string> names;
  const auto take = [&](const char* table, const auto& use) {
    std::error_code error;
    if (!fs::is_regular_file(directory / table, error)) return;
    try {
      use(directory / table);
    } catch (const FileError&) {  // it is no dataset's, and names nothing
    }
  };
  const auto take_pairs = [&](const fs::path& table) {
    for (const TruePair& pair : read_pairs(table)) names.insert({pair.fixed.name, pair.moving.name});
  };
  take(kPairs, take_pairs);
  take(kOnBuilding, take_pairs);
  take(kNegatives, [&](const fs::path& table) {
    for (const NegativePair& pair : read_negatives(table)) names.insert({pair.fixed.name, pair.moving.name});
  });
  take(kSets, [&](const fs::path& table) {
    for (const TrueSet& set : read_sets(table)) {
      for (const TrueMember& member : set.members) names.insert(member.map.name);
    }
  });
  return names;
}

bool is_number(std::string_view text) {
  return !text.empty() && text.find_first_not_of("0123456789") == std::string_view::npos;
}

/// The map of a dataset that a file belongs to: "robot_2.yaml" of "robot_2_step_1.pgm". Empty for other
/// files.
std::string map_of_file(const fs::path& file) {
  if (file.extension() != ".yaml" && file.extension() != ".pgm") return {};
  constexpr std::string_view kStep = "_step_";
  std::string stem = file.stem().string();
  const std::size_t step = stem.find(kStep);
  if (step != std::string::npos && is_number(std::string_view(stem).substr(step + kStep.size())))
    stem.resize(step);
  for (const std::string_view prefix : {"robot_", "elsewhere_"}) {
    if (stem.starts_with(prefix) && is_number(std::string_view(stem).substr(prefix.size())))
      return stem + ".yaml";
  }
  return {};
}

/// The maps of an earlier dataset that this one has none for: they are of another building.
void remove_stale(FileSet& files, const fs::path& directory, const std::set<std::string>& current) {
  const std::set<std::string> earlier = maps_of_tables(directory);
  std::error_code error;
  for (const std::string& name : names_in(directory, error)) {
    if (current.contains(name) || !earlier.contains(map_of_file(name))) continue;
    if (fs::is_regular_file(directory / name, error)) files.remove(name);
  }
}

}  // namespace

void prepare_dataset(const fs::path& directory) {
  check_directory(directory);
  for (const char* const name : {kBuilding, kPairs, kOnBuilding, kNegatives, kSets})
    check_destination(directory / name);
}

void write_dataset(const fs::path& directory, const Simulation& simulation,
                   const std::vector<Simulation>& elsewhere, const DatasetOptions& options) {
  FileSet files(directory, FileSet::IfMissing::make);
  std::set<std::string> current;
  const auto add = [&](const OccupancyGrid& grid, const std::string& name, bool probabilities) {
    probabilities ? add_probability_map(files, grid, name) : add_map(files, grid, name);
    current.insert({name, fs::path(name).replace_extension(".pgm").string()});
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
  files.add(kPairs, format_pairs(true_pairs(simulation)));
  files.add(kOnBuilding, format_pairs(on_building(simulation)));
  files.add(kNegatives, format_negatives(negatives(simulation, others)));
  files.add(kSets, format_sets(sets(simulation)));
  remove_stale(files, directory, current);
  files.commit();
}

}  // namespace gridmerge::internal
