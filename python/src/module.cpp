// SPDX-License-Identifier: Apache-2.0
#include "bindings.hpp"

NB_MODULE(_core, module) {
  using namespace gridmerge::python;
  module.doc() = "The engine. Not to be used directly: the package gridmerge checks arguments and documents.";
  // A thread that still runs when Python ends keeps its maps alive; nanobind would print a page about that.
  nb::set_leak_warnings(false);
  bind_errors(module);
  bind_worker(module);
  bind_grid(module);
  bind_io(module);
  bind_bag(module);
  bind_match(module);
  bind_measure(module);
  bind_deformation(module);
  bind_cache(module);
  bind_merge(module);
  bind_merger(module);
  bind_plan(module);
  bind_random_walk(module);
  bind_record(module);
  bind_simulate(module);
  bind_evaluate(module);
  bind_tasks(module);
  bind_team(module);
}
