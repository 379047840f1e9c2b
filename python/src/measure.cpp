// SPDX-License-Identifier: Apache-2.0
#include "gridmerge/match/measure.hpp"

#include <nanobind/stl/map.h>

#include <map>

#include "bindings.hpp"
#include "gridmerge/grid/execution.hpp"
#include "gridmerge/search/random_walk.hpp"
#include "gridmerge/similarity/image_similarity.hpp"
#include "table.hpp"
#include "worker.hpp"

namespace gridmerge::python {

using namespace internal;

namespace {

std::vector<PlacedMap> placed(const std::vector<Map>& maps, const std::vector<Pose>& poses) {
  std::vector<PlacedMap> placed;
  for (std::size_t i = 0; i < maps.size(); ++i) placed.push_back({maps[i].grid.get(), to_se2(poses.at(i))});
  return placed;
}

JointMeasure measure(const Map& fixed, const std::vector<Map>& moving, const std::vector<Pose>& poses,
                     int threads) {
  return compute_in_worker(
      nb::none(), [&](const Report&) { return measure_maps(*fixed.grid, placed(moving, poses), threads); });
}

Map draw(const Map& lattice, const Map& map, const Pose& pose) {
  const OthersRun meanwhile;
  return {
      std::make_shared<const OccupancyGrid>(draw_on_lattice(*lattice.grid, {map.grid.get(), to_se2(pose)})),
      {},
      {}};
}

std::int64_t count_equal(const Map& lattice, const std::vector<Map>& maps, const std::vector<Pose>& poses) {
  const OthersRun meanwhile;
  return count_equal_cells(*lattice.grid, placed(maps, poses));
}

/// What is left of the distance map at the start, after the forward pass, and after the backward pass.
std::vector<nb::bytes> distance_maps(const Map& map, int value) {
  DistanceMapPasses passes;
  {
    const OthersRun meanwhile;
    passes = trace_distance_map(*map.grid, static_cast<Cell>(value));
  }
  return {to_bytes(passes.start.distances), to_bytes(passes.forward.distances),
          to_bytes(passes.backward.distances)};
}

nb::bytes measure_many(const Map& fixed, const Map& moving, const std::vector<Pose>& poses, int threads) {
  std::vector<SE2> at;
  for (const Pose& pose : poses) at.push_back(to_se2(pose));
  return to_bytes(compute_in_worker(nb::none(), [&](const Report&) {
    std::vector<double> table;
    with_threads(threads, [&] {
      for (const MeasuredPose& pose : measure_poses(*fixed.grid, *moving.grid, at))
        append_figures(table, pose.T_fixed_moving, pose.similarity);
    });
    return table;
  }));
}

std::vector<Pose> cut(const Map& moving, const Pose& from, const Pose& to, int count) {
  std::vector<Pose> poses;
  for (const SE2& T : poses_between(*moving.grid, to_se2(from), to_se2(to), count))
    poses.push_back(to_pose(T));
  return poses;
}

std::optional<double> mean(const DirectedDistance& distance) {
  return distance.defined() ? std::optional(distance.mean()) : std::nullopt;
}

std::map<std::string, double> figures(const PoseMeasure& measure) {
  std::map<std::string, double> named;
  for (const PoseFigure& figure : pose_figures()) named[figure.name] = measure.engine.figures.*figure.value;
  return named;
}

}  // namespace

void bind_measure(nb::module_& module) {
  nb::class_<PoseMeasure>(module, "PoseMeasure")
      .def_prop_ro("transform", [](const PoseMeasure& it) { return to_pose(it.T_fixed_moving); })
      .def_prop_ro("omega", [](const PoseMeasure& it) { return it.similarity.omega; })
      .def_ro("cells", &PoseMeasure::cells)
      .def_prop_ro("psi", [](const PoseMeasure& it) { return it.similarity.psi(); })
      .def_prop_ro("psi_terms",
                   [](const PoseMeasure& it) {
                     const ImageSimilarity& similarity = it.similarity;
                     return std::vector{
                         mean(similarity.fixed_to_moving_occupied), mean(similarity.fixed_to_moving_free),
                         mean(similarity.moving_to_fixed_occupied), mean(similarity.moving_to_fixed_free)};
                   })
      .def_prop_ro("agreement", [](const PoseMeasure& it) { return it.similarity.agreement; })
      .def_prop_ro("disagreement", [](const PoseMeasure& it) { return it.similarity.disagreement; })
      .def_prop_ro("acceptance_index", [](const PoseMeasure& it) { return it.similarity.acceptance_index(); })
      .def_prop_ro("occupied_occupied", [](const PoseMeasure& it) { return it.common.occupied_occupied; })
      .def_prop_ro("free_free", [](const PoseMeasure& it) { return it.common.free_free; })
      .def_prop_ro("contradicting", [](const PoseMeasure& it) { return it.common.contradicting; })
      .def_prop_ro("probability", [](const PoseMeasure& it) { return it.engine.probability; })
      .def_prop_ro("figures", &figures);
  nb::class_<JointMeasure>(module, "JointMeasure")
      .def_ro("omega", &JointMeasure::omega)
      .def_ro("cells", &JointMeasure::cells)
      .def_ro("pairs", &JointMeasure::pairs);
  module.def("measure", &measure, nb::arg("fixed"), nb::arg("moving"), nb::arg("poses"), nb::arg("threads"));
  module.def("draw_on_lattice", &draw, nb::arg("lattice"), nb::arg("grid"), nb::arg("pose"));
  module.def("count_equal_cells", &count_equal, nb::arg("lattice"), nb::arg("maps"), nb::arg("poses"));
  module.def("distance_maps", &distance_maps, nb::arg("grid"), nb::arg("value"));
  module.def("measure_poses", &measure_many, nb::arg("fixed"), nb::arg("moving"), nb::arg("poses"),
             nb::arg("threads"));
  module.def("poses_between", &cut, nb::arg("moving"), nb::arg("start"), nb::arg("end"), nb::arg("count"));
}

}  // namespace gridmerge::python
