// SPDX-License-Identifier: Apache-2.0
#include <utility>

#include "bindings.hpp"
#include "gridmerge/bag/bag.hpp"
#include "gridmerge/io/initial_poses.hpp"
#include "gridmerge/io/map_file.hpp"
#include "worker.hpp"

namespace gridmerge::python {

Map to_map(LoadedMap loaded) {
  for (std::filesystem::path& one : loaded.files) one = std::filesystem::absolute(one);
  std::vector<std::string> warnings;
  for (MapWarning& warning : loaded.warnings) warnings.push_back(std::move(warning.text));
  return {std::make_shared<const OccupancyGrid>(std::move(loaded.grid)), std::move(warnings),
          std::move(loaded.files)};
}

namespace {

Map load(const nb::bytes& path, double resolution, bool literal_thresholds) {
  const std::filesystem::path file = to_string(path);
  LoadOptions options;
  options.resolution = resolution;
  options.literal_thresholds = literal_thresholds;
  const OthersRun meanwhile;
  return to_map(load_any_map(file, options));
}

void save(const Map& map, const nb::bytes& path, bool probabilities) {
  const std::filesystem::path file = to_string(path);
  const OthersRun meanwhile;
  probabilities ? save_probability_map(*map.grid, file) : save_map(*map.grid, file);
}

}  // namespace

void bind_io(nb::module_& module) {
  module.attr("MIN_RESOLUTION") = kMinResolution;
  module.attr("MAX_RESOLUTION") = kMaxResolution;
  module.def("load", &load, nb::arg("path"), nb::arg("resolution"), nb::arg("literal_thresholds"));
  module.def("save", &save, nb::arg("grid"), nb::arg("path"), nb::arg("probabilities"));
  nb::class_<InitialPose>(module, "InitialPose")
      .def_prop_ro("name", [](const InitialPose& pose) { return to_str(pose.name); })
      .def_prop_ro("path", [](const InitialPose& pose) { return to_str(pose.path.string()); })
      .def_prop_ro("transform", [](const InitialPose& pose) { return to_pose(pose.T_world_map); })
      .def_ro("sd", &InitialPose::sd_position)
      .def_ro("sd_theta", &InitialPose::sd_theta);
  module.def(
      "read_initial_poses",
      [](const nb::bytes& path) {
        const std::filesystem::path file = to_string(path);
        const OthersRun meanwhile;
        return read_initial_poses(file);
      },
      nb::arg("path"));
}

}  // namespace gridmerge::python
