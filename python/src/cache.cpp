// SPDX-License-Identifier: Apache-2.0
#include "cache.hpp"

#include "gridmerge/match/stored_match.hpp"
#include "worker.hpp"

namespace gridmerge::python {

namespace {

std::optional<nb::bytes> find(Cache& cache, const std::string& key) {
  const std::optional<MatchResult> match = [&] {
    const OthersRun meanwhile;
    return cache.matches().find(key);
  }();
  if (match) cache.count(1, 0);
  return match ? std::optional(to_nb_bytes(to_bytes(*match))) : std::nullopt;
}

void keep(Cache& cache, const std::string& key, const nb::bytes& match) {
  const MatchResult result = match_from_bytes(to_string(match));
  cache.count(0, 1);
  const OthersRun meanwhile;
  cache.matches().keep_if_possible(key, result);
}

void announce(Cache& cache, double accept) {
  const OthersRun meanwhile;
  cache.matches().announce(accept);
}

std::string key_of(const std::string& fixed, const std::string& moving, const std::string& search,
                   double accept, std::size_t max_hypotheses) {
  MatchOptions options;
  options.max_hypotheses = max_hypotheses;
  set_search(options, search, accept);
  return match_key(fixed, moving, options);
}

}  // namespace

void bind_cache(nb::module_& module) {
  nb::class_<Cache>(module, "MatchCache")
      .def(nb::init<const nb::bytes&>(), nb::arg("directory"))
      .def("find", &find, nb::arg("key"))
      .def("keep", &keep, nb::arg("key"), nb::arg("match"))
      .def("announce", &announce, nb::arg("accept"))
      .def("counted", &Cache::counted)
      .def("take_warnings", [](Cache& cache) { return to_strs(cache.take_warnings()); });
  module.def("match_key", &key_of, nb::arg("fixed"), nb::arg("moving"), nb::arg("search"), nb::arg("accept"),
             nb::arg("max_hypotheses"));
}

}  // namespace gridmerge::python
