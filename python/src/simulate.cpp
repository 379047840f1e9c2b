// SPDX-License-Identifier: Apache-2.0
#include "gridmerge/simulate/simulate.hpp"

#include <nanobind/ndarray.h>

#include <array>
#include <stdexcept>
#include <utility>

#include "bindings.hpp"
#include "evaluate/dataset.hpp"
#include "simulate_bytes.hpp"
#include "worker.hpp"

namespace gridmerge::python {

using namespace internal;

namespace {

constexpr double kBuildingResolution = 0.05;  // [m], as write_dataset() draws it

/// A simulation with maps of other buildings.
struct Dataset {
  std::shared_ptr<const Simulation> simulation;
  std::vector<std::shared_ptr<const Simulation>> elsewhere;
};

/// A map of a simulation, which it keeps alive.
struct RobotMap {
  std::shared_ptr<const Simulation> simulation;
  std::size_t robot = 0;

  const SimulatedMap& map() const { return simulation->maps.at(robot); }
};

Dataset simulate_maps(const SimulateOptions& wanted, int others, const nb::object& progress) {
  return compute_in_worker(progress, [&](const Report& report) {
    SimulateOptions options = wanted;
    Dataset dataset;
    options.progress = [&](double share) { report(share / (1.0 + others)); };
    dataset.simulation = std::make_shared<const Simulation>(simulate(options));
    for (int i = 0; i < others; ++i) {
      SimulateOptions other = elsewhere(options, i);
      other.progress = [&, i](double share) { report((i + 1 + share) / (1.0 + others)); };
      dataset.elsewhere.push_back(std::make_shared<const Simulation>(simulate(other)));
    }
    return dataset;
  });
}

std::vector<RobotMap> maps_of(const std::shared_ptr<const Simulation>& simulation) {
  std::vector<RobotMap> maps;
  for (std::size_t i = 0; i < simulation->maps.size(); ++i) maps.push_back({simulation, i});
  return maps;
}

nb::ndarray<nb::numpy, double, nb::ndim<2>> path_of(const RobotMap& robot) {
  const std::vector<SE2>& path = robot.map().path;
  auto values = std::make_unique<std::vector<double>>();
  values->reserve(3 * path.size());
  for (const SE2& pose : path) values->insert(values->end(), {pose.x, pose.y, pose.theta});
  double* data = values->data();
  const nb::capsule owner(values.release(), [](void* owned) noexcept {
    std::unique_ptr<std::vector<double>>(static_cast<std::vector<double>*>(owned)).reset();
  });
  return {data, {path.size(), std::size_t{3}}, owner};
}

void save(const Dataset& dataset, const nb::bytes& directory, bool probabilities) {
  const std::filesystem::path path = to_string(directory);
  const OthersRun meanwhile;
  std::vector<Simulation> elsewhere;
  elsewhere.reserve(dataset.elsewhere.size());
  for (const auto& other : dataset.elsewhere) elsewhere.push_back(*other);
  write_dataset(path, *dataset.simulation, elsewhere, {probabilities});
}

/// The building's simulation, then those of other buildings.
std::vector<nb::bytes> state_of(const Dataset& dataset) {
  std::vector<std::string> states;
  {
    const OthersRun meanwhile;
    states.push_back(to_bytes(*dataset.simulation));
    for (const auto& other : dataset.elsewhere) states.push_back(to_bytes(*other));
  }
  std::vector<nb::bytes> told;
  for (const std::string& state : states) told.push_back(to_nb_bytes(state));
  return told;
}

/// Of what state_of() gave.
Dataset from_state(const std::vector<nb::bytes>& told) {
  std::vector<std::string> states;
  for (const nb::bytes& state : told) states.push_back(to_string(state));
  const OthersRun meanwhile;
  Dataset dataset;
  dataset.simulation = std::make_shared<const Simulation>(simulation_from_bytes(states.at(0)));
  for (std::size_t i = 1; i < states.size(); ++i)
    dataset.elsewhere.push_back(std::make_shared<const Simulation>(simulation_from_bytes(states[i])));
  return dataset;
}

void set_kind(SimulateOptions& options, const std::string& name) {
  const std::optional<BuildingKind> kind = building_kind(name);
  if (!kind) throw std::invalid_argument("there is no kind of building '" + name + "'");
  options.kind = *kind;
}

void bind_options(nb::module_& module) {
  nb::class_<RangeFinder>(module, "RangeFinder")
      .def_rw("field_of_view", &RangeFinder::field_of_view)
      .def_rw("angular_step", &RangeFinder::angular_step)
      .def_rw("range", &RangeFinder::range)
      .def_rw("noise", &RangeFinder::noise)
      .def_rw("stray_share", &RangeFinder::stray_share)
      .def_rw("missed_share", &RangeFinder::missed_share);
  nb::class_<SimulateOptions>(module, "SimulateOptions")
      .def(nb::init<>())
      .def("set_kind", &set_kind, nb::arg("name"))
      .def("add_start",
           [](SimulateOptions& options, double x, double y) {
             options.starts.push_back({x, y});
           })
      .def("add_heading",
           [](SimulateOptions& options, double heading) { options.headings.push_back(heading); })
      .def_rw("width", &SimulateOptions::width)
      .def_rw("height", &SimulateOptions::height)
      .def_rw("robots", &SimulateOptions::robots)
      .def_rw("overlap", &SimulateOptions::overlap, nb::arg().none())
      .def_rw("longest_way", &SimulateOptions::longest_way)
      .def_rw("sensor", &SimulateOptions::sensor)
      .def_rw("drift", &SimulateOptions::drift)
      .def_rw("steps", &SimulateOptions::steps)
      .def_rw("clutter", &SimulateOptions::clutter)
      .def_rw("resolution", &SimulateOptions::resolution)
      .def_rw("tidy", &SimulateOptions::tidy, nb::arg().none())
      .def_rw("seed", &SimulateOptions::seed)
      .def_rw("threads", &SimulateOptions::threads);
}

void bind_results(nb::module_& module) {
  nb::class_<RobotMap>(module, "RobotMap")
      .def_prop_ro("grid",
                   [](const RobotMap& robot) {
                     return Map{{robot.simulation, &robot.map().grid}, {}, {}};
                   })
      .def_prop_ro("transform", [](const RobotMap& robot) { return to_pose(robot.map().T_building_map); })
      .def_prop_ro("bend", [](const RobotMap& robot) { return robot.map().bend; })
      .def_prop_ro("earlier",
                   [](const RobotMap& robot) {
                     std::vector<Map> maps;
                     for (const OccupancyGrid& grid : robot.map().earlier)
                       maps.push_back({{robot.simulation, &grid}, {}, {}});
                     return maps;
                   })
      .def("path", &path_of);
  nb::class_<SimulatedPair>(module, "SimulatedPair")
      .def_ro("fixed", &SimulatedPair::fixed)
      .def_ro("moving", &SimulatedPair::moving)
      .def_prop_ro("transform", [](const SimulatedPair& pair) { return to_pose(pair.T_fixed_moving); })
      .def_ro("tolerance", &SimulatedPair::tolerance)
      .def_ro("overlap", &SimulatedPair::overlap)
      .def_prop_ro("tier", [](const SimulatedPair& pair) { return std::string(1, pair.tier); })
      .def_ro("shared_wall", &SimulatedPair::shared_wall);
  nb::class_<Dataset>(module, "Dataset")
      .def("__deepcopy__", [](const nb::object& dataset, const nb::object& /*memo*/) { return dataset; })
      .def("building",
           [](const Dataset& dataset) {
             const OthersRun meanwhile;
             OccupancyGrid drawn = draw_building(dataset.simulation->building, kBuildingResolution);
             return Map{std::make_shared<const OccupancyGrid>(std::move(drawn)), {}, {}};
           })
      .def_prop_ro("maps", [](const Dataset& dataset) { return maps_of(dataset.simulation); })
      .def_prop_ro("elsewhere",
                   [](const Dataset& dataset) {
                     std::vector<RobotMap> maps;
                     for (const auto& other : dataset.elsewhere) {
                       for (RobotMap& map : maps_of(other)) maps.push_back(std::move(map));
                     }
                     return maps;
                   })
      .def_prop_ro("pairs", [](const Dataset& dataset) { return dataset.simulation->pairs; })
      .def_prop_ro("strangers", [](const Dataset& dataset) { return dataset.simulation->strangers; })
      .def_prop_ro("overlap", [](const Dataset& dataset) { return dataset.simulation->overlap; })
      .def("state", &state_of)
      .def_static("from_state", &from_state, nb::arg("state"))
      .def("save", &save, nb::arg("directory"), nb::arg("probabilities"));
}

}  // namespace

void bind_simulate(nb::module_& module) {
  bind_options(module);
  bind_results(module);
  module.def("building_kinds", [] {
    std::vector<std::string> names;
    for (const BuildingKind kind : building_kinds()) names.emplace_back(name_of(kind));
    return names;
  });
  module.def("simulate", &simulate_maps, nb::arg("options"), nb::arg("others"), nb::arg("progress").none());
}

}  // namespace gridmerge::python
