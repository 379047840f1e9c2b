// SPDX-License-Identifier: Apache-2.0
#include "gridmerge/evaluate/evaluate.hpp"

#include <utility>

#include "cache.hpp"
#include "evaluate/count.hpp"
#include "evaluate/tables.hpp"
#include "gridmerge/match/stored_match.hpp"
#include "merge.hpp"
#include "worker.hpp"

namespace gridmerge::python {

using namespace internal;

namespace {

/// An evaluation, and what the files of its maps say that their authors may not have meant.
struct Evaluated {
  Evaluation evaluation;
  std::vector<std::string> warnings;
  double accept = 0.0;
};

std::string path_or_empty(const std::optional<nb::bytes>& path) {
  return path ? to_string(*path) : std::string();
}

EvaluateOptions make_options(const MatchOptions& match_options, bool up_the_tree, Cache* cache) {
  EvaluateOptions options;
  options.matcher = [=](const OccupancyGrid& fixed, const OccupancyGrid& moving) {
    if (cache == nullptr) return match(fixed, moving, match_options);
    std::size_t made = 0;
    const std::string key = match_key(content_id(fixed), content_id(moving), match_options);
    MatchResult result = cache->matches().find_or_make(key, [&] {
      cache->matches().announce(match_options.accept_probability);
      ++made;
      return match(fixed, moving, match_options);
    });
    cache->count(1 - made, made);
    return result;
  };
  options.merger = [=, matcher = options.matcher](const std::vector<OccupancyGrid>& maps) {
    if (up_the_tree) return merge_up_tree(maps, matcher, {.threads = match_options.threads});
    MergeOptions joint;
    joint.match = match_options;
    Merger merger(maps, joint);
    if (cache != nullptr) {
      const MatchWork done = match_with_cache(merger, cache->matches());
      cache->count(done.found, done.made);
    }
    return merger.solve();
  };
  return options;
}

Truth read_truth(const std::optional<nb::bytes>& pairs, const std::optional<nb::bytes>& negatives,
                 const std::optional<nb::bytes>& sets) {
  const std::string pairs_path = path_or_empty(pairs), negatives_path = path_or_empty(negatives),
                    sets_path = path_or_empty(sets);
  return compute_in_worker(nb::none(), [&](const Report& /*report*/) {
    Truth truth;
    if (pairs) truth.pairs = read_pairs(pairs_path);
    if (negatives) truth.negatives = read_negatives(negatives_path);
    if (sets) truth.sets = read_sets(sets_path);
    return truth;
  });
}

/// What was matched and merged before.
struct Answers {
  std::vector<MatchResult> matches;
  std::vector<std::shared_ptr<const MergeResult>> merges;
};

/// evaluate() asks for each once, in the order of the tables.
void take_answers(const Answers& answers, EvaluateOptions& options) {
  options.matcher = [&answers, next = std::size_t{0}](const OccupancyGrid&, const OccupancyGrid&) mutable {
    return answers.matches.at(next++);
  };
  options.merger = [&answers, next = std::size_t{0}](const std::vector<OccupancyGrid>&) mutable {
    return *answers.merges.at(next++);
  };
}

Evaluated evaluate_truth(const Truth& truth, EvaluateOptions options, double accept, double resolution,
                         bool literal_thresholds, const nb::object& progress) {
  return compute_in_worker(progress, [&](const Report& report) {
    Evaluated evaluated;
    evaluated.accept = accept;
    options.progress = [&](std::size_t done, std::size_t total) {
      report(static_cast<double>(done) / static_cast<double>(total));
    };
    options.load.resolution = resolution;
    options.load.literal_thresholds = literal_thresholds;
    options.warn = [&](const std::string& warning) { evaluated.warnings.push_back(warning); };
    evaluated.evaluation = evaluate(truth, options);
    return evaluated;
  });
}

Evaluated evaluate_here(const Truth& truth, int threads, std::optional<double> accept, bool up_the_tree,
                        const std::string& search, double resolution, bool literal_thresholds, Cache* cache,
                        const nb::object& progress) {
  MatchOptions match_options;
  match_options.threads = threads;
  set_search(match_options, search, accept);
  const double accepted_from = match_options.search == SearchMethod::random_walk
                                   ? match_options.random_walk.accept_acceptance_index
                                   : match_options.accept_probability;
  return evaluate_truth(truth, make_options(match_options, up_the_tree, cache), accepted_from, resolution,
                        literal_thresholds, progress);
}

Evaluated evaluate_answers(const Truth& truth, const std::vector<nb::bytes>& matches,
                           const std::vector<Merged>& merges, double accept, double resolution,
                           bool literal_thresholds) {
  Answers answers;
  for (const nb::bytes& match : matches) answers.matches.push_back(match_from_bytes(to_string(match)));
  for (const Merged& merged : merges) answers.merges.push_back(merged.result);
  EvaluateOptions options;
  take_answers(answers, options);
  return evaluate_truth(truth, std::move(options), accept, resolution, literal_thresholds, nb::none());
}

/// The path of a map, and which line names it.
std::pair<nb::bytes, nb::str> told(const TruthMap& map) {
  return {to_nb_bytes(map.path.string()), to_str(map.named_at)};
}

void bind_truth(nb::module_& module) {
  nb::class_<Truth>(module, "Truth")
      .def_prop_ro("matches",
                   [](const Truth& truth) {
                     std::vector<std::pair<std::pair<nb::bytes, nb::str>, std::pair<nb::bytes, nb::str>>> all;
                     for (const TruePair& pair : truth.pairs)
                       all.emplace_back(told(pair.fixed), told(pair.moving));
                     for (const NegativePair& pair : truth.negatives)
                       all.emplace_back(told(pair.fixed), told(pair.moving));
                     return all;
                   })
      .def_prop_ro("sets", [](const Truth& truth) {
        std::vector<std::vector<std::pair<nb::bytes, nb::str>>> sets;
        for (const TrueSet& set : truth.sets) {
          sets.emplace_back();
          for (const TrueMember& member : set.members) sets.back().push_back(told(member.map));
        }
        return sets;
      });
  module.def("read_truth", &read_truth, nb::arg("pairs").none(), nb::arg("negatives").none(),
             nb::arg("sets").none());
}

void bind_counts(nb::module_& module) {
  nb::class_<PairCounts>(module, "PairCounts")
      .def_ro("total", &PairCounts::total)
      .def_ro("accepted_correct", &PairCounts::accepted_correct)
      .def_ro("accepted_wrong", &PairCounts::accepted_wrong)
      .def_ro("refused", &PairCounts::refused)
      .def_ro("best_correct", &PairCounts::best_correct);
  nb::class_<NegativeCounts>(module, "NegativeCounts")
      .def_ro("total", &NegativeCounts::total)
      .def_ro("accepted", &NegativeCounts::accepted);
  nb::class_<SetCounts>(module, "SetCounts")
      .def_ro("total", &SetCounts::total)
      .def_ro("maps", &SetCounts::maps)
      .def_ro("maps_correct", &SetCounts::maps_correct)
      .def_ro("maps_wrong", &SetCounts::maps_wrong)
      .def_ro("maps_left_out", &SetCounts::maps_left_out)
      .def_ro("complete", &SetCounts::complete);
  nb::class_<TimeSummary>(module, "TimeSummary")
      .def_ro("median", &TimeSummary::median)
      .def_ro("p90", &TimeSummary::p90)
      .def_ro("max", &TimeSummary::max);
}

void bind_outcomes(nb::module_& module) {
  nb::class_<MatchOutcome>(module, "MatchOutcome")
      .def_prop_ro("fixed", [](const MatchOutcome& match) { return to_str(match.fixed); })
      .def_prop_ro("moving", [](const MatchOutcome& match) { return to_str(match.moving); })
      .def_prop_ro("tier", [](const MatchOutcome& match) { return to_str(match.tier); })
      .def_prop_ro("verdict", [](const MatchOutcome& match) { return name_of(match.verdict); })
      .def_prop_ro("reason", [](const MatchOutcome& match) { return name_of(match.reason); })
      .def_ro("probability", &MatchOutcome::probability)
      .def_ro("error", &MatchOutcome::error)
      .def_ro("tolerance", &MatchOutcome::tolerance)
      .def_prop_ro("negative", &MatchOutcome::negative)
      .def_prop_ro("correct", &MatchOutcome::correct)
      .def_ro("seconds", &MatchOutcome::seconds);
  nb::class_<SetOutcome>(module, "SetOutcome")
      .def_prop_ro("name", [](const SetOutcome& set) { return to_str(set.name); })
      .def_ro("maps", &SetOutcome::maps)
      .def_ro("correct", &SetOutcome::correct)
      .def_ro("wrong", &SetOutcome::wrong)
      .def_ro("left_out", &SetOutcome::left_out);
}

}  // namespace

void bind_evaluate(nb::module_& module) {
  bind_counts(module);
  bind_outcomes(module);
  nb::class_<Evaluated>(module, "Evaluation")
      .def_prop_ro("pairs", [](const Evaluated& it) { return count_pairs(it.evaluation.matches); })
      .def_prop_ro("negatives", [](const Evaluated& it) { return count_negatives(it.evaluation.matches); })
      .def_prop_ro("sets", [](const Evaluated& it) { return count_sets(it.evaluation.sets); })
      .def_prop_ro("seconds", [](const Evaluated& it) { return summarize_times(it.evaluation.matches); })
      .def_prop_ro("matches", [](const Evaluated& it) { return it.evaluation.matches; })
      .def_prop_ro("set_outcomes", [](const Evaluated& it) { return it.evaluation.sets; })
      .def_prop_ro("warnings", [](const Evaluated& it) { return to_strs(it.warnings); })
      .def("to_json", [](const Evaluated& it) { return to_str(evaluation_json(it.evaluation)); })
      .def("summary", [](const Evaluated& it) { return to_str(summary_table(it.evaluation, it.accept)); });
  bind_truth(module);
  module.def("evaluate", &evaluate_here, nb::arg("truth"), nb::arg("threads"), nb::arg("accept").none(),
             nb::arg("up_the_tree"), nb::arg("search"), nb::arg("resolution"), nb::arg("literal_thresholds"),
             nb::arg("cache").none(), nb::arg("progress").none());
  module.def("evaluate_answers", &evaluate_answers, nb::arg("truth"), nb::arg("matches"), nb::arg("merges"),
             nb::arg("accept"), nb::arg("resolution"), nb::arg("literal_thresholds"));
}

}  // namespace gridmerge::python
