// SPDX-License-Identifier: Apache-2.0
// What the parts of the extension module share.
#pragma once

#include <nanobind/nanobind.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "gridmerge/grid/occupancy_grid.hpp"
#include "gridmerge/io/map_file.hpp"
#include "gridmerge/match/match.hpp"

namespace gridmerge::python {

namespace nb = nanobind;

/// A transform or pose on its way between the languages: x, y [m], theta [rad].
using Pose = std::tuple<double, double, double>;

inline SE2 to_se2(const Pose& pose) {
  return {std::get<0>(pose), std::get<1>(pose), std::get<2>(pose)};
}

// No -0.0, as in the JSON of the command line: it reads as a direction that is not there.
inline Pose to_pose(const SE2& T) {
  return {T.x + 0.0, T.y + 0.0, T.theta + 0.0};
}

/// A map that Python holds. It never changes, so that views of it and work on it need no lock.
struct Map {
  std::shared_ptr<const OccupancyGrid> grid;
  std::vector<std::string> warnings;         // of the file
  std::vector<std::filesystem::path> files;  // that it was read from
};

/// As Python holds it: the paths are absolute, as the program may go to another directory.
Map to_map(LoadedMap loaded);

/// Text that the library gives: names of files are any bytes, and come back as os.fsdecode() gives them.
nb::str to_str(const std::string& text);
std::vector<nb::str> to_strs(const std::vector<std::string>& texts);

/// Paths and names come as os.fsencode() gives them.
inline std::string to_string(const nb::bytes& bytes) {
  return {bytes.c_str(), bytes.size()};
}

inline nb::bytes to_nb_bytes(const std::string& bytes) {
  return nb::bytes(bytes.data(), bytes.size());
}

/// How pairs are matched, as Python says it: `accept` is a probability, or the acceptance index of the random
/// walk, and the usual one if there is none. `search` is one of search_methods().
void set_search(MatchOptions& options, const std::string& search, std::optional<double> accept);

void bind_bag(nb::module_& module);
void bind_cache(nb::module_& module);
void bind_errors(nb::module_& module);
void bind_worker(nb::module_& module);
void bind_grid(nb::module_& module);
void bind_io(nb::module_& module);
void bind_match(nb::module_& module);
void bind_measure(nb::module_& module);
void bind_merge(nb::module_& module);
void bind_merger(nb::module_& module);
void bind_plan(nb::module_& module);
void bind_random_walk(nb::module_& module);
void bind_record(nb::module_& module);
void bind_simulate(nb::module_& module);
void bind_deformation(nb::module_& module);
void bind_evaluate(nb::module_& module);
void bind_tasks(nb::module_& module);
void bind_team(nb::module_& module);

}  // namespace gridmerge::python
