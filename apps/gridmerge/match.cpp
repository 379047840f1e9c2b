// SPDX-License-Identifier: Apache-2.0
#include "gridmerge/match/match.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <iterator>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "commands.hpp"
#include "console.hpp"
#include "match/drawing.hpp"
#include "match/rounded_down.hpp"
#include "report/json_lines.hpp"
#include "scale_hint.hpp"
#include "scarce_memory.hpp"
#include "search_options.hpp"

namespace gridmerge::cli {

using namespace internal;

namespace {

struct MatchCommandOptions {
  CommonOptions common;
  std::string fixed;
  std::string moving;
  LoadOptions load;
  SearchOptions search;
  bool json = false;

  bool scaled() const { return !search.scales.empty(); }
};

std::string describe_verdict(const MatchResult& result, const SearchOptions& search) {
  if (search.random_walk() && !result.hypotheses.empty()) {
    if (result.verdict == Verdict::refused && result.acceptance_index >= search.accept_from())
      return "refused: the maps have too little in common, or one has no free or no occupied cells there";
    return fmt::format("{}: the acceptance index is {:.4f}, and {} is asked for", name_of(result.verdict),
                       rounded_down(result.acceptance_index), search.accept_from());
  }
  if (result.verdict == Verdict::accepted) {
    return fmt::format("accepted: {}, with probability {:.4f}", explain(result),
                       rounded_down(result.probability));
  }
  const std::string why = explain(result, search.accept_from());
  // Where nothing was compared no pose has a probability.
  return result.reason == Reason::nothing_to_compare
             ? "refused: " + why
             : fmt::format("refused: {} (probability {:.4f})", why, rounded_down(result.probability));
}

std::string describe_line(const std::string& name, const std::string& value) {
  return fmt::format("  {:<14}{}\n", name, value);
}

std::string describe(const MatchResult& result, const MatchCommandOptions& options, double moving_cell) {
  std::string text = describe_verdict(result, options.search) + "\n";
  const auto line = [&](const std::string& name, const std::string& value) {
    text += describe_line(name, value);
  };
  if (result.hypotheses.empty()) {
    line("time", fmt::format(" {:.3f} s", result.seconds));
    return text;
  }
  line("T_fixed_moving", " " + describe_pose(result.T_fixed_moving));
  if (options.scaled())
    line("scale", fmt::format(" {:.4f}, by which MOVING is enlarged first: its cells are {:.4g} m",
                              result.scale, result.scale * moving_cell));
  line("agreement", fmt::format(" {} cells agree, {} do not (acceptance index {:.3f})", result.agreement,
                                result.disagreement, rounded_down(result.acceptance_index, 3)));
  line("overlap", fmt::format(" {:.1f} % of the smaller map", 100.0 * result.overlap));
  line("time", fmt::format(" {:.3f} s", result.seconds));
  if (!options.common.verbose) return text;
  for (std::size_t i = 0; i < result.hypotheses.size(); ++i) {
    const Hypothesis& hypothesis = result.hypotheses[i];
    const std::string scale = options.scaled() ? fmt::format(", scale {:.4f}", hypothesis.scale) : "";
    const std::string figures = options.search.random_walk()
                                    ? fmt::format("acceptance index {:.4f}", rounded_down(hypothesis.score))
                                    : fmt::format("score {:.4g}, probability {:.4f}", hypothesis.score,
                                                  rounded_down(hypothesis.probability));
    line(fmt::format("hypothesis {}", i + 1),
         fmt::format(" {}{}, {}", describe_pose(hypothesis.T_fixed_moving), scale, figures));
  }
  return text;
}

/// Throws std::runtime_error for a map that tells no scale.
void check_walls(const std::string& name, const OccupancyGrid& map) {
  if (count_cells(map).occupied == 0 && count_cells(with_enclosed_free(map)).occupied == 0)
    throw std::runtime_error(name + ": has no walls by which to tell a scale");
}

/// A map whose resolution is to be known.
LoadedMap read_to_scale(const std::string& name, const MatchCommandOptions& options, MapReader& reader) {
  const bool may_be_scaled = search_method(options.search.method) != SearchMethod::random_walk;
  if (!may_be_scaled || !reader.lacks_resolution(name)) return reader.read(name);
  try {
    return reader.read(name);
  } catch (const FileError& lacks) {
    throw std::runtime_error(std::string(lacks.what()) + "; --scale 0.5:2 finds that of a plan");
  }
}

/// The fixed one and the moving one. Where the scale is to be found, the resolution of one of them may be
/// unknown.
std::pair<LoadedMap, LoadedMap> read_maps(const MatchCommandOptions& options, MapReader& reader) {
  if (!options.scaled()) {
    LoadedMap fixed = read_to_scale(options.fixed, options, reader);
    return {std::move(fixed), read_to_scale(options.moving, options, reader)};
  }
  if (reader.lacks_resolution(options.fixed)) {
    LoadedMap moving = reader.read(options.moving);
    return {reader.read(options.fixed, moving.grid.resolution, options.moving), std::move(moving)};
  }
  LoadedMap fixed = reader.read(options.fixed);
  LoadedMap moving = reader.read(options.moving, fixed.grid.resolution, options.fixed);
  return {std::move(fixed), std::move(moving)};
}

struct Answer {
  Verdict verdict;
  std::string text;
};

/// Of maps that are drawings, what was made of them.
std::string describe_drawings(const std::vector<NamedMap>& maps) {
  std::string text;
  for (const NamedMap& map : maps) {
    if (!is_drawing(map.grid)) continue;
    const CellCounts counts = count_cells(with_enclosed_free(map.grid));
    const double area = static_cast<double>(counts.free) * map.grid.resolution * map.grid.resolution;
    text += describe_line(
        "drawing", fmt::format(" {}: the {:.1f} m2 that its lines enclose, in its own metres, are free",
                               escape_controls(map.name), area));
  }
  return text;
}

Answer match_loaded(const MatchCommandOptions& options, const LoadedMap& fixed, const LoadedMap& moving,
                    MapReader& reader, Console& console) {
  if (options.scaled()) {
    check_walls(options.fixed, fixed.grid);
    check_walls(options.moving, moving.grid);
  }
  reader.tell_warnings();
  if (!options.search.trace.empty()) {
    std::vector<std::filesystem::path> inputs = fixed.files;
    inputs.insert(inputs.end(), moving.files.begin(), moving.files.end());
    try_output_file(options.search.trace, inputs);
  }
  PairMatcher matcher(options.common, options.search,
                      [&](double share) { console.progress("matching", share); });
  try {
    const MatchResult result = matcher(fixed.grid, moving.grid);
    matcher.write_trace();
    if (options.json)
      return {result.verdict, match_json(options.fixed, options.moving, result, options.scaled())};
    const NamedMap fixed_map{options.fixed, fixed.grid}, moving_map{options.moving, moving.grid};
    std::string text = describe(result, options, moving.grid.resolution);
    if (options.scaled()) text += describe_drawings({fixed_map, moving_map});
    if (options.scaled() && result.verdict == Verdict::refused)
      text += range_hint(fixed_map, moving_map, to_scales(options.search.scales), "--scale");
    const bool may_hint = !options.scaled() && !options.search.random_walk();
    if (may_hint && result.verdict == Verdict::refused) {
      console.progress("trying other scales");
      const char* const what_helps = "--scale 0.5:2 finds its scale and place";
      const std::string hint = plan_hint(fixed_map, what_helps);
      text += hint.empty() ? plan_hint(moving_map, what_helps) : hint;
      text += scale_hint(fixed_map, moving_map, match_options(options.common, options.search));
    }
    return {result.verdict, std::move(text)};
  } catch (const std::invalid_argument& error) {
    throw std::runtime_error(options.fixed + " and " + options.moving + ": " + error.what());
  }
}

Answer match_files(const MatchCommandOptions& options) {
  Console console(options.common);
  MapReader reader(options.load, console);
  const auto [fixed, moving] = read_maps(options, reader);
  const auto match_them = [&, &fixed = fixed, &moving = moving] {
    return match_loaded(options, fixed, moving, reader, console);
  };
  return with_scarce_memory(match_them, [&, &fixed = fixed, &moving = moving] {
    return fmt::format("while matching {} and {}: maps of larger cells take less",
                       describe_size(options.fixed, fixed.grid), describe_size(options.moving, moving.grid));
  });
}

int run_match(const MatchCommandOptions& options) {
  const Answer answer = match_files(options);
  print(answer.text);
  return answer.verdict == Verdict::accepted ? kDone : kRefused;
}

}  // namespace

void add_match(CLI::App& app, Action& action) {
  CLI::App* command =
      app.add_subcommand("match", "Find how one map lies on another, and whether to believe it");
  const auto options = std::make_shared<MatchCommandOptions>();
  command->add_option("FIXED", options->fixed, std::string(kMapHelp))->type_name("MAP")->required();
  command->add_option("MOVING", options->moving, "The map to lay on it")->type_name("FILE")->required();
  command->add_flag("--json", options->json, "Print JSON, on one line");
  add_search_options(*command, options->search);
  add_scale_option(*command, options->search);
  add_start_option(*command, options->search);
  add_trace_option(*command, options->search);
  add_map_file_options(*command, options->load);
  add_common_options(*command, options->common);
  command->footer(
      "The transform takes points of MOVING to FIXED, in metres and radians of the map frames.\n"
      "It is given for a refused pair too; the exit code is 3 then.\n\n"
      "Example:\n  gridmerge match robot1.yaml robot2.yaml\n  gridmerge match team.mcap#/tb1/map "
      "team.mcap#/tb2/map\n  gridmerge match robot1.yaml layout.yaml --scale 0.5:2");
  command->callback([options, &action] { action = [options] { return run_match(*options); }; });
}

}  // namespace gridmerge::cli
