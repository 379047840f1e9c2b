// SPDX-License-Identifier: Apache-2.0
#include "gridmerge/merge/plan.hpp"

#include <utility>

#include "gridmerge/grid/execution.hpp"
#include "merge.hpp"
#include "worker.hpp"

namespace gridmerge::python {

using namespace internal;

namespace {

Merged place(const Merged& merged, const Map& plan, const nb::bytes& name, std::pair<double, double> scales,
             int threads, std::optional<double> accept, double max_false_joins, double output_resolution,
             const std::string& search) {
  MergeOptions options;
  options.match.threads = threads;
  set_search(options.match, search, accept);
  options.max_false_joins = max_false_joins;
  options.resolution = output_resolution;
  PlanOptions plan_options;
  plan_options.scales = {scales.first, scales.second};
  plan_options.name = to_string(name);
  MergeResult result = compute_in_worker(nb::none(), [&](const Report&) {
    return place_on_plan(grids_of(merged.maps), *plan.grid, *merged.result, options, plan_options);
  });
  return {merged.maps, std::make_shared<const MergeResult>(std::move(result)), plan.grid};
}

}  // namespace

void bind_plan(nb::module_& module) {
  module.attr("DEFAULT_LEAST_PLAN_SCALE") = PlanOptions{}.scales.least;
  module.attr("DEFAULT_MOST_PLAN_SCALE") = PlanOptions{}.scales.most;
  nb::class_<PlanPart>(module, "PlanPart")
      .def_ro("maps", &PlanPart::maps)
      .def_prop_ro("transform", [](const PlanPart& part) { return to_pose(part.T_plan_first); })
      .def_ro("scale", &PlanPart::scale)
      .def_ro("probability", &PlanPart::probability)
      .def_prop_ro("on_plan", &PlanPart::on_plan)
      .def_prop_ro("reason", [](const PlanPart& part) { return name_of(part.reason); })
      .def_prop_ro("explanation", [](const PlanPart& part) { return explain(part); });
  nb::class_<PlanPlacement>(module, "PlanPlacement")
      .def_prop_ro("name", [](const PlanPlacement& plan) { return to_str(plan.name); })
      .def_ro("scale", &PlanPlacement::scale)
      .def_prop_ro("probability", &PlanPlacement::probability)
      .def_ro("parts", &PlanPlacement::parts);
  module.def(
      "validate_plan",
      [](const std::vector<Map>& maps, const Map& plan, int threads) {
        const OthersRun meanwhile;
        with_threads(threads, [&] { validate_plan(grids_of(maps), *plan.grid); });
      },
      nb::arg("maps"), nb::arg("plan"), nb::arg("threads"));
  module.def("place_on_plan", &place, nb::arg("merged"), nb::arg("plan"), nb::arg("name"), nb::arg("scales"),
             nb::arg("threads"), nb::arg("accept").none(), nb::arg("max_false_joins"),
             nb::arg("output_resolution"), nb::arg("search"));
}

}  // namespace gridmerge::python
