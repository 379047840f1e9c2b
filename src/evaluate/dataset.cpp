// SPDX-License-Identifier: Apache-2.0
#include "evaluate/dataset.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <string_view>
#include <system_error>

#include "grid/sha256.hpp"
#include "gridmerge/evaluate/evaluate.hpp"
#include "gridmerge/io/file_error.hpp"
#include "io/add_map.hpp"
#include "io/destination.hpp"
#include "io/file_reader.hpp"

namespace gridmerge::internal {

namespace {

namespace fs = std::filesystem;

constexpr const char* kBuilding = "building.yaml";
constexpr const char* kPairs = "pairs.tsv";
constexpr const char* kOnBuilding = "building.tsv";
constexpr const char* kNegatives = "negatives.tsv";
constexpr const char* kSets = "sets.tsv";
constexpr const char* kList = "simulation.sha256";
constexpr std::string_view kListHead = "# gridmerge simulate wrote these files";
constexpr std::string_view kBetween = "  ";  // a digest and its file

constexpr std::size_t kMaxBytes = std::size_t{1} << 29;  // of a file: a map has 2^28 cells at most

TruthMap robot_map(std::size_t robot) {
  return {fmt::format("robot_{}.yaml", robot + 1), {}};
}

/// The same at an earlier moment.
std::string map_at(std::size_t robot, std::size_t step) {
  return fmt::format("robot_{}_step_{}.yaml", robot + 1, step + 1);
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

std::set<std::string> files_of(const DatasetSize& size) {
  std::set<std::string> names{kPairs, kOnBuilding, kNegatives, kSets, kList};
  const auto add = [&](const std::string& map) {
    names.insert({map, fs::path(map).replace_extension(".pgm").string()});
  };
  add(kBuilding);
  for (std::size_t robot = 0; robot < size.robots; ++robot) {
    add(robot_map(robot).name);
    for (std::size_t step = 0; step + 1 < size.steps; ++step) add(map_at(robot, step));
  }
  for (std::size_t other = 0; other < size.others; ++other) add(elsewhere_map(other).name);
  return names;
}

DatasetSize size_of(const Simulation& simulation, const std::vector<Simulation>& elsewhere) {
  DatasetSize size{simulation.maps.size(), 1, 0};
  if (size.robots > 0) size.steps += simulation.maps.front().earlier.size();
  for (const Simulation& other : elsewhere) size.others += other.maps.size();
  return size;
}

std::string digest_of(std::string_view bytes) {
  return to_hex(Sha256().add(bytes).digest());
}

std::string digest_of_file(const fs::path& path) {
  FileReader reader(path, NamedBy::file);
  return digest_of(reader.read_all(kMaxBytes));
}

/// What `sha256sum -c` reads, of a set whose other files are all added.
std::string list_files(const FileSet& files, std::set<std::string> names) {
  names.erase(kList);
  std::string text = fmt::format("{}\n", kListHead);
  for (const std::string& name : names)
    fmt::format_to(std::back_inserter(text), "{}{}{}\n", digest_of_file(files.staged(name)), kBetween, name);
  return text;
}

/// The files of an earlier dataset, and their digests when it was written. None where it left no list.
std::map<std::string, std::string> listed_files(const fs::path& directory) {
  std::map<std::string, std::string> digests;
  try {
    FileReader reader(directory / kList, NamedBy::file);
    const std::string& text = reader.read_all(kMaxBytes);
    std::istringstream lines(text);
    std::string line;
    if (!std::getline(lines, line) || line != kListHead) return {};
    digests[kList] = digest_of(text);
    while (std::getline(lines, line)) {
      const std::size_t at = line.find(kBetween);
      if (at == std::string::npos) continue;
      const std::string name = line.substr(at + kBetween.size());
      if (!name.empty() && name.front() != '.' && fs::path(name).filename() == name)
        digests[name] = line.substr(0, at);
    }
  } catch (const FileError&) {  // there is no dataset
  }
  return digests;
}

bool has_digest(const fs::path& path, const std::string& digest) {
  try {
    return digest_of_file(path) == digest;
  } catch (const FileError&) {
    return false;
  }
}

[[noreturn]] void refuse(const fs::path& directory, const std::vector<std::string>& foreign) {
  constexpr std::size_t kNamed = 10;
  const std::size_t named = std::min(foreign.size(), kNamed);
  std::string names = fmt::format("{}", fmt::join(foreign.begin(), foreign.begin() + named, ", "));
  if (foreign.size() > named) names += fmt::format(" and {} more", foreign.size() - named);
  throw FileError(directory,
                  fmt::format("files would be replaced or removed that no simulation wrote, or that have "
                              "changed since: {}: choose another directory, or move them away",
                              names));
}

/// The files of an earlier dataset that this one has none for: they are of another building. Throws FileError
/// where anything but an earlier dataset is in the way.
std::vector<std::string> stale_files(const fs::path& directory, const std::set<std::string>& current) {
  const std::map<std::string, std::string> earlier = listed_files(directory);
  std::set<std::string> touched = current;
  for (const auto& [name, digest] : earlier) touched.insert(name);
  std::vector<std::string> stale, foreign;
  for (const std::string& name : touched) {
    std::error_code error;
    if (!fs::exists(fs::symlink_status(directory / name, error))) continue;
    const auto own = earlier.find(name);
    if (own == earlier.end() || !has_digest(directory / name, own->second)) {
      foreign.push_back(name);
    } else if (!current.contains(name)) {
      stale.push_back(name);
    }
  }
  if (!foreign.empty()) refuse(directory, foreign);
  return stale;
}

}  // namespace

void prepare_dataset(const fs::path& directory, const DatasetSize& size) {
  check_directory(directory);
  const std::set<std::string> names = files_of(size);
  for (const std::string& name : names) check_destination(directory / name);
  stale_files(directory, names);
}

std::vector<fs::path> write_dataset(const fs::path& directory, const Simulation& simulation,
                                    const std::vector<Simulation>& elsewhere, const DatasetOptions& options) {
  FileSet files(directory, FileSet::IfMissing::make);
  const DatasetSize size = size_of(simulation, elsewhere);
  const std::set<std::string> names = files_of(size);
  const std::vector<std::string> stale = stale_files(directory, names);
  const auto add = [&](const OccupancyGrid& grid, const std::string& name) {
    options.probabilities ? add_probability_map(files, grid, name) : add_map(files, grid, name);
  };
  for (std::size_t i = 0; i < simulation.maps.size(); ++i) {
    const SimulatedMap& map = simulation.maps[i];
    add(map.grid, robot_map(i).name);
    for (std::size_t step = 0; step < map.earlier.size(); ++step) add(map.earlier[step], map_at(i, step));
  }
  std::size_t others = 0;
  for (const Simulation& other : elsewhere) {
    for (const SimulatedMap& map : other.maps) add(map.grid, elsewhere_map(others++).name);
  }
  add_map(files, draw_building(simulation.building, 0.05), kBuilding);
  files.add(kPairs, format_pairs(true_pairs(simulation)));
  files.add(kOnBuilding, format_pairs(on_building(simulation)));
  files.add(kNegatives, format_negatives(negatives(simulation, size.others)));
  files.add(kSets, format_sets(sets(simulation)));
  files.add(kList, list_files(files, names));
  std::vector<fs::path> removed;
  for (const std::string& name : stale) {
    files.remove(name);
    removed.push_back(directory / name);
  }
  files.commit();
  return removed;
}

}  // namespace gridmerge::internal
