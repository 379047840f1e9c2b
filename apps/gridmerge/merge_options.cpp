// SPDX-License-Identifier: Apache-2.0
#include "merge_options.hpp"

namespace gridmerge::cli {

namespace {

/// What --help says behind the options.
constexpr const char* kFooter =
    "Writes merged.yaml and merged.pgm for map_server if maps join, transforms.json, preview.png and\n"
    "report.html. Maps that do not fit are left out and the exit code is 3. Of an earlier merge into DIR,\n"
    "maps and exports that this one does not write are removed, and named.\n\n"
    "Every pair is matched, and what all pairs say together decides: a weak pair that agrees with the\n"
    "others is used (rescued), a strong one that contradicts them is not (rejected).\n\n"
    "With --cache a run that was ended goes on where it was. --shard shares the matches among machines "
    "that\n"
    "see one directory. Pairs are looked at in two rounds: quickly, and thoroughly those whose maps that\n"
    "leaves apart. A shard needs no other for the first round, and all others for the second. So run "
    "every\n"
    "shard, wait for all, and run every shard once more; the merge itself makes what is missing, says how\n"
    "much that was, and warns of shards with another N, other maps, options or versions. Of more\n"
    "than 50 maps there may be more rounds: --max-missed chooses pairs by what was found before. A shard's\n"
    "exit code is 3 while matches of the merge are missing, and 0 when all are there:\n"
    "  gridmerge merge --cache matches --shard 1/2 robot*.yaml   (and 2/2 elsewhere)\n"
    "  gridmerge merge --cache matches --shard 1/2 robot*.yaml   (when both have ended; and 2/2 "
    "elsewhere)\n"
    "  gridmerge merge --cache matches robot*.yaml -o merged\n\n"
    "Example:\n  gridmerge merge robot1.yaml robot2.yaml robot3.yaml -o merged\n"
    "  gridmerge merge robot1.yaml robot2.yaml -o merged --export g2o --export open-rmf=fleet.yaml\n"
    "  gridmerge merge robot1.mcap team.mcap#/tb2/map team.mcap#/tb3/map -o merged\n"
    "  gridmerge merge robot1.yaml robot2.yaml --plan layout.yaml -o merged\n"
    "  gridmerge merge robot1.yaml --plan layout.yaml -o placed\n"
    "  gridmerge merge robot1.yaml robot2.yaml --transform similarity -o merged\n"
    "  gridmerge merge robot1.yaml robot2.yaml --init poses.tsv --fix robot1.yaml -o merged\n"
    "  gridmerge merge robot1.yaml robot2.yaml --init poses.tsv --fix robot1.yaml --fix robot2.yaml -o "
    "merged";

/// The maps and where the merged one goes.
void add_files(CLI::App& command, MergeCommandOptions& options) {
  command.add_option("MAP", options.maps, std::string(kMapHelp))
      ->type_name("MAP")
      ->required()
      ->expected(1, -1);
  command
      .add_option("-o,--output", options.output,
                  "Directory for the results, needed unless --shard is given; made if need be")
      ->type_name("DIR");
  command
      .add_option(
          "--output-resolution", options.output_resolution,
          "Metres per cell of the merged map; if not given, those of the finest map, or so many more, "
          "up to 16 times, that it has at most 2^28 cells")
      ->type_name("METRES")
      ->check(kMetresPerCell);
}

/// --max-false-joins.
CLI::Option* add_budget(CLI::App& command, MergeCommandOptions& options) {
  return command
      .add_option(
          "--max-false-joins", options.max_false_joins,
          "How many joins of the whole merge may be expected to be false, or of more than 50 maps "
          "for every 50; those that are least sure are not made. The parts on a --plan have a second budget "
          "of the same size. It holds beside --accept, which is asked of each join")
      ->type_name("NUMBER")
      ->check(kNotNegative)
      ->capture_default_str();
}

/// --max-missed, and --all-pairs, which excludes it.
CLI::Option* add_choice_of_pairs(CLI::App& command, MergeCommandOptions& options) {
  CLI::Option* missed =
      command
          .add_option("--max-missed", options.max_missed,
                      "Of more than 50 maps match likely pairs only: the others may hide this share of all "
                      "joins, 0.25 or so. Up to 0.2 all pairs are matched, as signatures of maps do not show "
                      "one join in five")
          ->type_name("SHARE")
          ->check(kProbability)
          ->capture_default_str();
  command
      .add_flag("--all-pairs", options.all_pairs,
                "Match all pairs, however many maps there are: --max-missed 0")
      ->excludes(missed);
  return missed;
}

/// Throws CLI::ValidationError for options of the joint merge that a tree has no use for.
void require_joint(const MergeCommandOptions& options) {
  if (!options.search.up_the_tree()) return;
  const KnownPoseOptions& known = options.known;
  if (!known.init.empty() || !known.fix.empty())
    throw CLI::ValidationError(known.init.empty() ? "--fix" : "--init", "needs --strategy joint");
  if (options.cache.is_used()) throw CLI::ValidationError("--cache", "needs --strategy joint");
  if (!options.plan.file.empty()) throw CLI::ValidationError("--plan", "needs --strategy joint");
}

}  // namespace

GivenMergeOptions add_merge_options(CLI::App& command, MergeCommandOptions& options) {
  GivenMergeOptions given;
  add_files(command, options);
  add_plan_options(command, options.plan);
  add_known_pose_options(command, options.known);
  add_search_options(command, options.search,
                     "a quick look at every pose of each pair, then a thorough one at pairs whose maps that "
                     "leaves apart");
  add_strategy_option(command, options.search);
  given.max_false_joins = add_budget(command, options);
  given.max_missed = add_choice_of_pairs(command, options);
  given.transform = add_transform_options(command, options.transform);
  add_trace_option(command, options.search);
  add_cache_option(command, options.cache);
  add_shard_option(command, options.cache);
  add_export_option(command, options.exports);
  add_map_file_options(command, options.load);
  add_common_options(command, options.common);
  command.footer(kFooter);
  return given;
}

void settle(MergeCommandOptions& options, const GivenMergeOptions& given) {
  if (options.maps.size() < 2 && options.plan.file.empty())
    throw CLI::ArgumentMismatch::AtLeast("MAP", 2, options.maps.size());
  const bool up_the_tree = options.search.up_the_tree();
  if (given.max_false_joins->count() > 0 && up_the_tree)
    throw CLI::ValidationError("--max-false-joins", "needs --strategy joint");
  settle_transform(given.transform, up_the_tree, options.transform);
  if (options.max_missed >= 1.0)
    throw CLI::ValidationError("--max-missed", "all joins may not be missed: give less than 1");
  if (given.max_missed->count() > 0 && up_the_tree)
    throw CLI::ValidationError("--max-missed", "needs --strategy joint");
  require_joint(options);
  if (!options.plan.file.empty() && !options.known.fix.empty())
    throw CLI::ValidationError("--plan", "excludes --fix: the merged map has one frame");
  const bool is_shard = options.cache.is_shard();
  if (is_shard && !options.plan.file.empty())
    throw CLI::ValidationError("--plan", "excludes --shard, which merges nothing");
  if (is_shard && !options.exports.wanted.empty())
    throw CLI::ValidationError("--export", "excludes --shard, which merges nothing");
  if (is_shard && !options.cache.is_used()) throw CLI::ValidationError("--shard", "needs --cache");
  if (is_shard && !options.output.empty())
    throw CLI::ValidationError("--shard", "merges nothing: leave -o out");
  if (!is_shard && options.output.empty()) throw CLI::RequiredError("--output");
}

}  // namespace gridmerge::cli
