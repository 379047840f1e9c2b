// SPDX-License-Identifier: Apache-2.0
#include <stdexcept>

#include "bindings.hpp"
#include "gridmerge/merge/merge.hpp"
#include "merge/pair_choice.hpp"
#include "worker.hpp"

namespace gridmerge::python {

using namespace internal;

namespace {

MatchResult match_maps(const Map& fixed, const Map& moving, int threads, std::optional<double> accept,
                       std::size_t max_hypotheses, const std::string& search,
                       std::optional<std::pair<double, double>> scales, const nb::object& progress) {
  MatchOptions options;
  options.threads = threads;
  options.max_hypotheses = max_hypotheses;
  set_search(options, search, accept);
  if (scales) options.scales = ScaleRange{scales->first, scales->second};
  return compute_in_worker(progress, [&](const Report& report) {
    options.progress = report;
    return match(*fixed.grid, *moving.grid, options);
  });
}

/// Whether a joint merge takes it.
bool is_joint(SearchMethod method) {
  MergeOptions options;
  options.match.search = method;
  try {
    validate(options);
  } catch (const std::invalid_argument&) {
    return false;
  }
  return true;
}

}  // namespace

void set_search(MatchOptions& options, const std::string& search, std::optional<double> accept) {
  options.search = search_method(search).value();
  if (accept) options.accept_probability = options.random_walk.accept_acceptance_index = *accept;
}

void bind_match(nb::module_& module) {
  module.attr("DEFAULT_ACCEPT") = MatchOptions{}.accept_probability;
  module.attr("DEFAULT_MAX_HYPOTHESES") = MatchOptions{}.max_hypotheses;
  module.attr("DEFAULT_MAX_FALSE_JOINS") = MergeOptions{}.max_false_joins;
  module.attr("DEFAULT_MAX_MISSED") = MergeOptions{}.max_missed;
  module.attr("FEW_MAPS") = kFewMaps;
  module.attr("HIDDEN_SHARE") = kHiddenShare;
  nb::class_<Hypothesis>(module, "Hypothesis")
      .def_prop_ro("transform", [](const Hypothesis& it) { return to_pose(it.T_fixed_moving); })
      .def_ro("score", &Hypothesis::score)
      .def_ro("scale", &Hypothesis::scale)
      .def_ro("probability", &Hypothesis::probability);
  nb::class_<PairPose>(module, "PairPose")
      .def_prop_ro("transform", [](const PairPose& pose) { return to_pose(pose.T_fixed_moving); })
      .def_ro("probability", &PairPose::probability)
      .def_ro("acceptance_index", &PairPose::acceptance_index)
      .def_ro("agreement", &PairPose::agreement)
      .def_ro("disagreement", &PairPose::disagreement)
      .def_ro("overlap", &PairPose::overlap);
  nb::class_<MatchResult, PairPose>(module, "MatchResult")
      .def_prop_ro("verdict", [](const MatchResult& result) { return name_of(result.verdict); })
      .def_prop_ro("reason", [](const MatchResult& result) { return name_of(result.reason); })
      .def(
          "explain", [](const MatchResult& result, double accept) { return explain(result, accept); },
          nb::arg("accept"))
      .def_ro("seconds", &MatchResult::seconds)
      .def_ro("scale", &MatchResult::scale)
      .def_ro("hypotheses", &MatchResult::hypotheses);
  module.def("search_methods", [] {
    std::vector<std::string> names;
    for (const SearchMethodName& one : search_methods()) names.emplace_back(one.name);
    return names;
  });
  module.def("joint_search_methods", [] {
    std::vector<std::string> names;
    for (const SearchMethodName& one : search_methods()) {
      if (is_joint(one.method)) names.emplace_back(one.name);
    }
    return names;
  });
  module.def("match", &match_maps, nb::arg("fixed"), nb::arg("moving"), nb::arg("threads"),
             nb::arg("accept").none(), nb::arg("max_hypotheses"), nb::arg("search"), nb::arg("scales").none(),
             nb::arg("progress").none());
}

}  // namespace gridmerge::python
