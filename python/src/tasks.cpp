// SPDX-License-Identifier: Apache-2.0
// Matches that are made apart from the merge that needs them, in this process or another one.
#include "bindings.hpp"
#include "gridmerge/bag/bag.hpp"
#include "gridmerge/grid/execution.hpp"
#include "gridmerge/match/stored_match.hpp"
#include "match/looked_twice.hpp"
#include "rounds.hpp"
#include "worker.hpp"

namespace gridmerge::python {

using namespace internal;

namespace {

/// A map with what its matches have in common. Never changes.
struct Prepared {
  std::shared_ptr<const PreparedMap> map;
};

Prepared prepare(const Map& map) {
  const OthersRun meanwhile;
  return {std::make_shared<const PreparedMap>(*map.grid)};
}

/// What a quick look has found, for the second look that may follow; none if these bytes are nothing of the
/// kind: then that look begins anew.
std::optional<QuickLook> quick_look_from(const std::string& bytes) {
  if (bytes.empty()) return std::nullopt;
  try {
    return match_from_bytes(bytes).hypotheses;
  } catch (const std::invalid_argument&) {
    return std::nullopt;
  }
}

/// The match and what a quick search has found. `found` is that of the same maps, or nothing: the exhaustive
/// search goes on from it, with the same answer.
std::pair<nb::bytes, nb::bytes> match_prepared(const Prepared& fixed, const Prepared& moving,
                                               const std::string& search, double accept,
                                               std::size_t max_hypotheses, const nb::bytes& found) {
  MatchOptions options;
  options.max_hypotheses = max_hypotheses;
  set_search(options, search, accept);
  const std::string before = to_string(found);
  const auto [made, now_found] = compute_in_worker(nb::none(), [&](const Report& /*report*/) {
    QuickMatch quick;
    with_threads(1, [&] {
      const std::optional<QuickLook> known = quick_look_from(before);
      if (options.search == SearchMethod::quick)
        quick = match_quickly(*fixed.map, *moving.map, options);
      else if (options.search == SearchMethod::exhaustive && known)
        quick.result = match_again(*fixed.map, *moving.map, options, *known);
      else
        quick.result = match(*fixed.map, *moving.map, options);
    });
    const bool is_quick = options.search == SearchMethod::quick;
    MatchResult kept;
    kept.hypotheses = std::move(quick.found);
    return std::pair(to_bytes(quick.result), is_quick ? to_bytes(kept) : std::string());
  });
  return {to_nb_bytes(made), to_nb_bytes(now_found)};
}

/// About how long a match takes, until it is known better [s per cell of both maps].
double seconds_per_cell(const std::string& search) {
  constexpr double kQuick = 3e-7, kOther = 1.5e-6;
  return search_method(search) == SearchMethod::quick ? kQuick : kOther;
}

Map load_regular(const nb::bytes& path, double resolution, bool literal_thresholds) {
  const std::filesystem::path file = to_string(path);
  LoadOptions options;
  options.resolution = resolution;
  options.literal_thresholds = literal_thresholds;
  options.regular_files_only = true;
  const OthersRun meanwhile;
  return to_map(load_any_map(file, options));
}

}  // namespace

void bind_tasks(nb::module_& module) {
  [[maybe_unused]] const nb::class_<Prepared> prepared(module, "Prepared");
  nb::class_<RoundsShare>(module, "RoundsShare")
      .def(nb::init<>())
      .def("of", &RoundsShare::of, nb::arg("done"), nb::arg("total"));
  module.def("engine_id", &engine_id);
  module.def(
      "content_id",
      [](const Map& map) {
        const OthersRun meanwhile;
        return content_id(*map.grid);
      },
      nb::arg("map"));
  module.def("prepare", &prepare, nb::arg("map"));
  module.def("match_prepared", &match_prepared, nb::arg("fixed"), nb::arg("moving"), nb::arg("search"),
             nb::arg("accept"), nb::arg("max_hypotheses"), nb::arg("found"));
  module.def("seconds_per_cell", &seconds_per_cell, nb::arg("search"));
  module.def("load_regular", &load_regular, nb::arg("path"), nb::arg("resolution"),
             nb::arg("literal_thresholds"));
  module.def(
      "seconds_of", [](const nb::bytes& match) { return match_from_bytes(to_string(match)).seconds; },
      nb::arg("match"));
}

}  // namespace gridmerge::python
