// SPDX-License-Identifier: Apache-2.0
#include "gridmerge/merge/merge.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <filesystem>
#include <iterator>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "cached_merge.hpp"
#include "commands.hpp"
#include "console.hpp"
#include "exports.hpp"
#include "gridmerge/grid/execution.hpp"
#include "gridmerge/merge/tree.hpp"
#include "gridmerge/report/merge_output.hpp"
#include "known_poses.hpp"
#include "merge_notices.hpp"
#include "merge_options.hpp"
#include "merge_summary.hpp"
#include "plan.hpp"
#include "scale_hint.hpp"
#include "scarce_memory.hpp"
#include "search_options.hpp"
#include "shown_command.hpp"

namespace gridmerge::cli {

using namespace internal;

namespace {

struct Inputs {
  std::vector<OccupancyGrid> maps;
  std::optional<Plan> plan;
  std::vector<std::filesystem::path> files;  // that all of it was read from
};

Inputs load_inputs(const MergeCommandOptions& options, const KnownPoses& known_poses, Console& console) {
  Inputs inputs;
  MapReader reader(options.load, console);
  for (LoadedMap& map : reader.read_all(options.maps, options.common.threads)) {
    inputs.maps.push_back(std::move(map.grid));
    inputs.files.insert(inputs.files.end(), map.files.begin(), map.files.end());
  }
  if (!options.plan.file.empty()) {
    inputs.plan.emplace(options.plan, options.maps, inputs.maps, reader);
    inputs.files.insert(inputs.files.end(), inputs.plan->files().begin(), inputs.plan->files().end());
  }
  reader.tell_warnings();
  tell_of_copies({options.maps, inputs.maps, known_poses.poses()}, options.search, !options.known.fix.empty(),
                 console);
  return inputs;
}

MergeResult merge_up_tree_named(const std::vector<OccupancyGrid>& maps, const MergeCommandOptions& options,
                                PairMatcher& matcher, const TreeOptions& engine) {
  const auto match_named = [&](const OccupancyGrid& fixed, const OccupancyGrid& moving) {
    try {
      return matcher(fixed, moving);
    } catch (const std::invalid_argument& error) {
      throw std::runtime_error(fmt::format("{}: {}", fmt::join(options.maps, ", "), error.what()));
    }
  };
  return merge_up_tree(maps, match_named, engine);
}

MergeOptions merge_options(const MergeCommandOptions& options, Console& console) {
  MergeOptions engine;
  engine.match = match_options(options.common, options.search);
  engine.resolution = options.output_resolution;
  engine.max_false_joins = options.max_false_joins;
  engine.transform = map_transform(options.transform).value();
  engine.max_missed = options.max_missed;
  engine.progress = [&console](std::size_t done, std::size_t total) {
    if (done < total) {
      console.progress("matching pairs", static_cast<double>(done) / static_cast<double>(total));
    } else {
      console.progress("arranging the maps");
    }
  };
  return engine;
}

/// Before the work begins. Who asks for all pairs by name knows it.
void tell_of_all_pairs(const MergeCommandOptions& options, std::size_t maps, const MergeOptions& engine,
                       Console& console) {
  if (options.search.up_the_tree() || options.all_pairs) return;
  const std::string text =
      describe_all_pairs(maps, engine, options.cache.shards(), "--max-missed 0.25 matches likely pairs only");
  if (!text.empty()) console.tell(text);
}

MergeResult merge_maps(const std::vector<OccupancyGrid>& maps,
                       const std::vector<std::optional<KnownPose>>& known_poses,
                       const MergeCommandOptions& options, PairMatcher& matcher, CachedEngine& cached,
                       const std::optional<double>& coarser, Console& console) {
  const MergeOptions engine = merge_options(options, console);
  try {
    if (options.search.up_the_tree())
      return merge_up_tree_named(maps, options, matcher,
                                 {engine.resolution, engine.progress, options.common.threads});
    tell_of_all_pairs(options, maps.size(), engine, console);
    return cached.merge(maps, engine, known_poses);
  } catch (const std::invalid_argument& error) {  // the maps are valid, so it is about the merged one
    const std::string what_helps = coarser ? fmt::format("try --output-resolution {:.2g}", *coarser)
                                           : "even in cells 16 times as large as those of its finest map: "
                                             "known poses put maps too far apart";
    throw FileError(options.output, fmt::format("{}: {}", error.what(), what_helps));
  }
}

/// Of the first maps that were left out: whether they fit the largest merged map, or where there is none
/// another map, at another scale.
std::string scale_hints(const MergeCommandOptions& options, const std::vector<OccupancyGrid>& maps,
                        const MergeResult& result, Console& console) {
  constexpr std::size_t kMaxHints = 2;  // each takes as long as ten matches
  if (options.search.up_the_tree() || result.left_out.empty() || maps.size() < 2) return {};
  const bool has_merged = !result.components.empty();
  const std::size_t first = result.left_out.front().map;
  const NamedMap fixed = has_merged ? NamedMap{"the merged map", result.components.front().fused.grid}
                                    : NamedMap{options.maps[first], maps[first]};
  std::string text;
  std::size_t asked = 0;
  for (const LeftOut& one : result.left_out) {
    const std::size_t map = one.map;
    const NamedMap left_out{options.maps[map], maps[map]};
    const std::string plan =
        plan_hint(left_out, fmt::format("--plan {} hangs the other maps on it", typed_file(left_out.name)));
    text += plan;
    if (!plan.empty()) continue;
    if ((!has_merged && map == first) || count_cells(maps[map]).known() == 0 || asked == kMaxHints) continue;
    ++asked;
    console.progress("trying other scales");
    text += scale_hint(fixed, left_out, match_options(options.common, options.search));
  }
  return text;
}

std::string describe_work(const MergeCommandOptions& options, const Inputs& inputs) {
  return fmt::format(
      "while merging {}: larger cells take less (of the merged map: --output-resolution), and so do fewer "
      "--threads",
      describe_sizes(options.maps, inputs.maps));
}

/// Of a plan that no map hangs on: whether the sizes of both speak for other scales.
std::string plan_scale_hint(const MergeCommandOptions& options, const Inputs& inputs,
                            const MergeResult& result) {
  if (!inputs.plan || !result.plan->maps_on_plan().empty()) return {};
  const NamedMap map = result.components.empty()
                           ? NamedMap{options.maps.front(), inputs.maps.front()}
                           : NamedMap{"the merged map", result.components.front().fused.grid};
  return range_hint(map, {options.plan.file, inputs.plan->grid()}, inputs.plan->scales(), "--plan-scale");
}

int run_shard(const MergeCommandOptions& options) {
  Console console(options.common);
  const KnownPoses known_poses(options.known, options.maps, console);
  CachedEngine cached(options.cache, console);
  const Inputs inputs = load_inputs(options, known_poses, console);
  const MergeOptions engine = merge_options(options, console);
  tell_of_all_pairs(options, inputs.maps.size(), engine, console);
  const ShardOutcome outcome =
      with_scarce_memory([&] { return cached.make_shard(inputs.maps, engine, known_poses.poses()); },
                         [&] { return describe_work(options, inputs); });
  console.clear();
  print(outcome.text);
  return outcome.is_all_made ? kDone : kRefused;
}

int run_merge(const MergeCommandOptions& options) {
  Console console(options.common);
  const KnownPoses known_poses(options.known, options.maps, console);
  CachedEngine cached(options.cache, console);
  Inputs inputs = load_inputs(options, known_poses, console);
  if (!options.known.init.empty()) inputs.files.emplace_back(options.known.init);
  prepare_merge_output(options.output, inputs.files);
  const std::optional<double> coarser =
      check_merged_size(options.maps, inputs.maps, options.output_resolution);
  if (coarser)
    console.warn(
        fmt::format("the merged map may have more than 2^28 cells, and is not written then: "
                    "--output-resolution {:.2g} makes it smaller",
                    *coarser));
  PairMatcher matcher(options.common, options.search);
  if (!options.search.trace.empty()) try_result_file(options.search.trace, options.output, inputs.files);
  const std::vector<Export> exports = exports_of(options.exports, options.output);
  try_exports(exports, options.output, inputs.files);
  if (!options.search.trace.empty())
    require_not_exported(exports, options.search.trace, "--export and --trace");
  MergeResult result;
  const NamedMerge named{options.maps, inputs.maps, result, inputs.plan ? &inputs.plan->grid() : nullptr};
  std::vector<std::filesystem::path> removed;
  const auto merge_and_write = [&] {
    result = merge_maps(inputs.maps, known_poses.poses(), options, matcher, cached, coarser, console);
    cached.tell_of_use();
    if (inputs.plan)
      result = inputs.plan->place(inputs.maps, std::move(result), merge_options(options, console), console);
    console.progress("writing the result");
    with_threads(options.common.threads,
                 [&] { removed = write_merge_output(options.output, inputs.files, named); });
  };
  with_scarce_memory(merge_and_write, [&] { return describe_work(options, inputs); });
  matcher.write_trace();
  std::string exported;
  std::exception_ptr not_exported;  // told behind what the merge has found
  try {
    if (!exports.empty()) console.progress("writing the exports");
    exported = write_exports(exports, inputs.files, named, options.common.threads);
  } catch (const FileError&) {
    not_exported = std::current_exception();
  }
  const AskedMerge asked{options.maps,
                         options.search,
                         options.load,
                         known_poses.poses(),
                         map_transform(options.transform).value(),
                         options.max_false_joins,
                         options.output_resolution != 0.0};
  const std::string hints = plan_scale_hint(options, inputs, result) +
                            scale_hints(options, inputs.maps, result, console) +
                            describe_doubled(asked, inputs.maps, result, options.common.verbose);
  console.clear();
  if (options.common.verbose) print(describe_joins(asked, result));
  print(describe_merge(asked, inputs.maps, result,
                       known_poses.describe_unused(inputs.maps, result, options.load)) +
        describe_plan(asked, result) + hints + describe_removed(removed, "merge"));
  print("look at it: " + escape_controls((std::filesystem::path(options.output) / "report.html").string()) +
        "\n");
  if (not_exported) std::rethrow_exception(not_exported);
  print(exported);
  const bool all_on_plan = !result.plan || std::all_of(result.plan->parts.begin(), result.plan->parts.end(),
                                                       [](const PlanPart& part) { return part.on_plan(); });
  const bool is_one = result.components.size() == 1 && result.left_out.empty();
  return (is_one || inputs.maps.size() == 1) && all_on_plan ? kDone : kRefused;
}

}  // namespace

void add_merge(CLI::App& app, Action& action) {
  CLI::App* command = app.add_subcommand("merge", "Merge maps into one, as far as they fit together");
  const auto options = std::make_shared<MergeCommandOptions>();
  const GivenMergeOptions given = add_merge_options(*command, *options);
  command->callback([options, given, &action] {
    settle(*options, given);
    action = [options] { return options->cache.is_shard() ? run_shard(*options) : run_merge(*options); };
  });
}

}  // namespace gridmerge::cli
