// SPDX-License-Identifier: Apache-2.0
#include "gridmerge/evaluate/evaluate.hpp"

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "cached_merge.hpp"
#include "commands.hpp"
#include "console.hpp"
#include "evaluate/tables.hpp"
#include "exports.hpp"
#include "io/atomic_file.hpp"
#include "merge_notices.hpp"
#include "search_options.hpp"

namespace gridmerge::cli {

using namespace internal;

namespace {

struct EvaluateCommandOptions {
  CommonOptions common;
  std::string pairs;
  std::string negatives;
  std::string sets;
  std::string json;
  std::string features;
  LoadOptions load;
  SearchOptions search;
  CacheOptions cache;

  bool writes_json_file() const { return !json.empty() && json != "-"; }
};

Truth read_truth(const EvaluateCommandOptions& options) {
  Truth truth;
  if (!options.pairs.empty()) truth.pairs = read_pairs(options.pairs);
  if (!options.negatives.empty()) truth.negatives = read_negatives(options.negatives);
  if (!options.sets.empty()) truth.sets = read_sets(options.sets);
  return truth;
}

Evaluation evaluate_files(const EvaluateCommandOptions& options) {
  Console console(options.common);
  const Truth truth = read_truth(options);
  std::vector<std::filesystem::path> inputs = input_files(truth);
  inputs.insert(inputs.end(), {options.pairs, options.negatives, options.sets});
  if (options.writes_json_file() && !options.features.empty())
    require_two_files(options.json, options.features, "--json and --features");
  if (options.writes_json_file()) try_output_file(options.json, inputs);
  if (!options.features.empty()) try_output_file(options.features, inputs);
  EvaluateOptions engine;
  engine.load = options.load;
  SearchOptions search = options.search;
  search.lists_all = !options.features.empty();
  CachedEngine cached(options.cache, console);
  PairMatcher matcher(options.common, search);
  engine.matcher = [&](const OccupancyGrid& fixed, const OccupancyGrid& moving) {
    return cached.match(fixed, moving, match_options(options.common, search),
                        [&] { return matcher(fixed, moving); });
  };
  engine.merger = [&](const std::vector<OccupancyGrid>& maps) {
    if (options.search.up_the_tree())
      return merge_up_tree(maps, engine.matcher, {.threads = options.common.threads});
    MergeOptions joint;
    joint.match = match_options(options.common, options.search);
    const std::string all_pairs =
        describe_all_pairs(maps.size(), joint, 1, "unlike merge, evaluate has no --max-missed");
    if (!all_pairs.empty()) console.tell(all_pairs);
    return cached.merge(maps, joint);
  };
  engine.progress = [&](std::size_t done, std::size_t total) {
    console.progress("evaluating", static_cast<double>(done) / static_cast<double>(total));
  };
  engine.warn = [&](const std::string& warning) { console.warn(warning); };
  Evaluation evaluation = evaluate(truth, engine);
  cached.tell_of_use();
  return evaluation;
}

int run_evaluate(const EvaluateCommandOptions& options) {
  const Evaluation evaluation = evaluate_files(options);
  if (!options.features.empty()) write_file_atomically(options.features, features_table(evaluation));
  if (options.json == "-") {
    print(evaluation_json(evaluation));
    return kDone;
  }
  // Before the file: should the disk be full by now, the result is not lost.
  if (options.common.verbose) print(case_table(evaluation) + "\n");
  print(summary_table(evaluation, options.search.accept_from()));
  if (options.writes_json_file()) write_file_atomically(options.json, evaluation_json(evaluation));
  return kDone;
}

}  // namespace

void add_evaluate(CLI::App& app, Action& action) {
  CLI::App* command = app.add_subcommand("evaluate", "Compare results with ground truth");
  const auto options = std::make_shared<EvaluateCommandOptions>();
  command->add_option("PAIRS", options->pairs, "Table of pairs with true transforms (TSV)")
      ->type_name("FILE");
  command->add_option("--negatives", options->negatives, "Table of pairs with no common place")
      ->type_name("FILE");
  command
      ->add_option(
          "--sets", options->sets,
          "Table of sets of maps to merge, with true poses. All pairs of a set are matched: there is no "
          "--max-missed as that of merge")
      ->type_name("FILE");
  command->add_option("--json", options->json, "Write JSON to this file; - prints it instead of the summary")
      ->type_name("FILE");
  command
      ->add_option("--features", options->features,
                   "Write what each verdict rests on to this file (TSV), one line per judged pose")
      ->type_name("FILE");
  add_search_options(*command, options->search);
  add_strategy_option(*command, options->search);
  add_cache_option(*command, options->cache);
  add_map_file_options(*command, options->load);
  add_common_options(*command, options->common);
  command->footer(
      "At least one of the three tables is needed; maps are named relative to the table. Tables are\n"
      "tab-separated, and their first line names the columns:\n"
      "  PAIRS        fixed moving x y theta tolerance, and optionally tier, overlap, shared_wall\n"
      "  --negatives  fixed moving\n"
      "  --sets       set map x y theta tolerance\n"
      "x, y and theta take points of the moving map to the fixed one, of a set's map to the set's frame\n"
      "(metres, radians); tolerance is the largest root mean square error that counts as correct "
      "(metres).\n\n"
      "Example:\n  gridmerge evaluate pairs.tsv --negatives negatives.tsv --json result.json");
  command->callback([options, &action] {
    if (options->pairs.empty() && options->negatives.empty() && options->sets.empty()) {
      throw CLI::ValidationError("evaluate", "give PAIRS, --negatives or --sets");
    }
    if (!options->features.empty() && options->search.random_walk())
      throw CLI::ValidationError("--features", "does not go with --search random-walk");
    if (options->cache.is_used() && options->search.random_walk())
      throw CLI::ValidationError("--cache", "does not go with --search random-walk");
    action = [options] { return run_evaluate(*options); };
  });
}

}  // namespace gridmerge::cli
