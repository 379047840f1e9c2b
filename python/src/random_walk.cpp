// SPDX-License-Identifier: Apache-2.0
#include <utility>

#include "bindings.hpp"
#include "gridmerge/match/random_walk_match.hpp"
#include "table.hpp"
#include "worker.hpp"

namespace gridmerge::python {

namespace {

struct NumberedWalk {
  double c_lock = 0.0;
  RandomWalkResult result;
};

struct WalkedMatch {
  MatchResult match;
  std::vector<NumberedWalk> walks;
};

WalkedMatch match_walking(const Map& fixed, const Map& moving, const RandomWalkMatchOptions& wanted,
                          const nb::object& progress) {
  return compute_in_worker(progress, [&](const Report& report) {
    RandomWalkMatchOptions options = wanted;
    WalkedMatch walked;
    options.progress = report;
    options.on_walk = [&](int, double c_lock, const RandomWalkResult& result) {
      walked.walks.push_back({c_lock, result});
    };
    walked.match = match_by_random_walk(*fixed.grid, *moving.grid, options);
    return walked;
  });
}

/// Rows of _random_walk._TRACE_COLUMNS.
nb::bytes trace_of(const NumberedWalk& walk) {
  std::vector<double> table;
  for (const WalkSample& sample : walk.result.trace) {
    table.insert(table.end(), {static_cast<double>(sample.step), sample.accepted ? 1.0 : 0.0,
                               sample.wide ? 1.0 : 0.0, sample.measured ? 1.0 : 0.0, sample.delta});
    append_figures(table, sample.T_fixed_moving, sample.similarity);
  }
  return to_bytes(table);
}

}  // namespace

void bind_random_walk(nb::module_& module) {
  nb::enum_<WalkTrace>(module, "WalkTrace")
      .value("none", WalkTrace::none)
      .value("accepted", WalkTrace::accepted)
      .value("all", WalkTrace::all);
  nb::class_<RandomWalkMatchOptions>(module, "RandomWalkOptions")
      .def(nb::init<>())
      .def_rw("c_locks", &RandomWalkMatchOptions::c_locks)
      .def_rw("restarts", &RandomWalkMatchOptions::restarts)
      .def_rw("accept", &RandomWalkMatchOptions::accept_acceptance_index)
      .def_rw("least_common_cells", &RandomWalkMatchOptions::least_common_cells)
      .def_rw("max_hypotheses", &RandomWalkMatchOptions::max_hypotheses)
      .def_rw("threads", &RandomWalkMatchOptions::threads)
      .def_prop_rw(
          "starts",
          [](const RandomWalkMatchOptions& it) {
            return std::tuple(it.start.rotations, it.start.offsets, it.start.offset);
          },
          [](RandomWalkMatchOptions& it, const std::tuple<int, int, double>& starts) {
            it.start = {std::get<0>(starts), std::get<1>(starts), std::get<2>(starts)};
          })
      .def_prop_rw(
          "start",
          [](const RandomWalkMatchOptions& it) {
            return it.start_pose ? std::optional(to_pose(*it.start_pose)) : std::nullopt;
          },
          [](RandomWalkMatchOptions& it, const Pose& start) { it.start_pose = to_se2(start); })
      .def_prop_rw(
          "memory", [](const RandomWalkMatchOptions& it) { return it.walk.memory; },
          [](RandomWalkMatchOptions& it, std::size_t value) { it.walk.memory = value; })
      .def_prop_rw(
          "first_step", [](const RandomWalkMatchOptions& it) { return it.walk.first_step; },
          [](RandomWalkMatchOptions& it, double value) { it.walk.first_step = value; })
      .def_prop_rw(
          "wide_share", [](const RandomWalkMatchOptions& it) { return it.walk.wide_share; },
          [](RandomWalkMatchOptions& it, double value) { it.walk.wide_share = value; })
      .def_prop_rw(
          "temperature", [](const RandomWalkMatchOptions& it) { return it.walk.temperature; },
          [](RandomWalkMatchOptions& it, double value) { it.walk.temperature = value; })
      .def_prop_rw(
          "cooling", [](const RandomWalkMatchOptions& it) { return it.walk.cooling; },
          [](RandomWalkMatchOptions& it, double value) { it.walk.cooling = value; })
      .def_prop_rw(
          "patience", [](const RandomWalkMatchOptions& it) { return it.walk.patience; },
          [](RandomWalkMatchOptions& it, std::size_t value) { it.walk.patience = value; })
      .def_prop_rw(
          "max_proposals", [](const RandomWalkMatchOptions& it) { return it.walk.max_proposals; },
          [](RandomWalkMatchOptions& it, std::size_t value) { it.walk.max_proposals = value; })
      .def_prop_rw(
          "seed", [](const RandomWalkMatchOptions& it) { return it.walk.seed; },
          [](RandomWalkMatchOptions& it, std::uint64_t value) { it.walk.seed = value; })
      .def_prop_rw(
          "trace", [](const RandomWalkMatchOptions& it) { return it.walk.trace; },
          [](RandomWalkMatchOptions& it, WalkTrace value) { it.walk.trace = value; });
  nb::class_<NumberedWalk>(module, "Walk")
      .def_ro("c_lock", &NumberedWalk::c_lock)
      .def_prop_ro("transform", [](const NumberedWalk& it) { return to_pose(it.result.T_fixed_moving); })
      .def_prop_ro("delta", [](const NumberedWalk& it) { return it.result.delta; })
      .def_prop_ro("psi", [](const NumberedWalk& it) { return it.result.similarity.psi(); })
      .def_prop_ro("omega", [](const NumberedWalk& it) { return it.result.similarity.omega; })
      .def_prop_ro("agreement", [](const NumberedWalk& it) { return it.result.similarity.agreement; })
      .def_prop_ro("disagreement", [](const NumberedWalk& it) { return it.result.similarity.disagreement; })
      .def_prop_ro("acceptance_index",
                   [](const NumberedWalk& it) { return it.result.similarity.acceptance_index(); })
      .def_prop_ro("proposals", [](const NumberedWalk& it) { return it.result.proposals; })
      .def_prop_ro("accepted", [](const NumberedWalk& it) { return it.result.accepted; })
      .def("trace", &trace_of);
  nb::class_<WalkedMatch>(module, "WalkedMatch")
      .def_ro("match", &WalkedMatch::match)
      .def_ro("walks", &WalkedMatch::walks);
  module.def("match_by_random_walk", &match_walking, nb::arg("fixed"), nb::arg("moving"), nb::arg("options"),
             nb::arg("progress").none());
}

}  // namespace gridmerge::python
