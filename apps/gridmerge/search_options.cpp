// SPDX-License-Identifier: Apache-2.0
#include "search_options.hpp"

#include <fmt/format.h>

#include <iterator>
#include <limits>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

#include "io/atomic_file.hpp"
#include "io/number.hpp"

namespace gridmerge::cli {

using namespace internal;

namespace {

constexpr const char* kTraceHead =
    "match,walk,c_lock,step,delta,psi,agr,dis,x,y,theta,omega,ai,accepted,wide\n";

/// The heading in --help of what only the random walk has, so that it does not stand between the other
/// options.
constexpr const char* kWalkGroup = "With --search random-walk";

}  // namespace

double SearchOptions::accept_from() const {
  const double usual =
      random_walk() ? RandomWalkMatchOptions{}.accept_acceptance_index : MatchOptions{}.accept_probability;
  return accept.value_or(usual);
}

namespace {

/// RxOxOFFSET. None if the text is anything else.
std::optional<StartPoseOptions> parse_starts(const std::string& text) {
  const std::size_t first = text.find('x');
  const std::size_t second = text.find('x', first + 1);
  if (first == std::string::npos || second == std::string::npos) return std::nullopt;
  const auto rotations = parse_whole(text.substr(0, first));
  const auto offsets = parse_whole(text.substr(first + 1, second - first - 1));
  const auto offset = parse_number(text.substr(second + 1));
  constexpr std::uint64_t kMost = std::numeric_limits<int>::max();
  if (!rotations || !offsets || !offset || *rotations > kMost || *offsets > kMost) return std::nullopt;
  return StartPoseOptions{static_cast<int>(*rotations), static_cast<int>(*offsets), *offset};
}

const CLI::Validator kStarts(
    [](std::string& text) {
      const std::optional<StartPoseOptions> starts = parse_starts(text);
      if (!starts) return "'" + text + "' is not RxOxOFFSET, as 72x1x100";
      try {
        validate(*starts);
      } catch (const std::invalid_argument& error) {
        return "'" + text + "': " + error.what();
      }
      return std::string();
    },
    "");

/// LO:HI. None if the text is anything else.
std::optional<ScaleRange> parse_scales(const std::string& text) {
  const std::size_t colon = text.find(':');
  if (colon == std::string::npos) return std::nullopt;
  const auto least = parse_number(text.substr(0, colon)), most = parse_number(text.substr(colon + 1));
  return least && most ? std::optional(ScaleRange{*least, *most}) : std::nullopt;
}

/// The options that only the random walk has.
std::vector<CLI::Option*> add_walk_options(CLI::App& command, SearchOptions& options) {
  RandomWalkMatchOptions& match = options.walk;
  RandomWalkOptions& walk = match.walk;
  std::vector<CLI::Option*> added;
  const auto add = [&](const std::string& name, auto& value, const std::string& help,
                       const char* type) -> CLI::Option* {
    added.push_back(command.add_option(name, value, help)->type_name(type)->group(kWalkGroup));
    return added.back();
  };
  const auto set_c_locks = [&match](const std::vector<std::string>& lists) {
    match.c_locks.clear();
    for (const std::string& list : lists) {
      const std::vector<double> numbers = parse_numbers(list).value();
      match.c_locks.insert(match.c_locks.end(), numbers.begin(), numbers.end());
    }
  };
  added.push_back(command
                      .add_option_function<std::vector<std::string>>(
                          "--c-lock", set_c_locks,
                          "The weight in Delta = psi + C (disagreement - agreement), which the walk makes "
                          "small; 0 if not given. Several, with commas, are used in turn, one for each walk")
                      ->type_name("C,...")
                      ->group(kWalkGroup)
                      ->check(kNumbersNotNegative));
  add("--restarts", options.restarts, "How many walks, the best is kept; one for each c_lock if not given",
      "N")
      ->transform(whole_number(1, 1000));
  add("--starts", options.starts,
      fmt::format("The grid of poses whose best one starts a walk: R rotations, O shifts on each side of "
                  "the centre in x and in y, OFFSET cells apart; {}x{}x{} if not given",
                  match.start.rotations, match.start.offsets, match.start.offset),
      "RxOxOFFSET")
      ->check(kStarts);
  add("--wide-share", walk.wide_share,
      "Share of proposals that are drawn from all poses: what lets the walk leave a wrong place", "SHARE")
      ->check(kProbability)
      ->capture_default_str();
  add("--temperature", walk.temperature,
      "A sample whose Delta is worse by d is accepted with probability exp(-d/T); 0 climbs", "T")
      ->check(kNotNegative)
      ->capture_default_str();
  add("--cooling", walk.cooling, "The temperature is multiplied with this after every proposal, in (0, 1]",
      "F")
      ->check(kNumber)
      ->capture_default_str();
  add("--memory", walk.memory, "Accepted steps that set mean and covariance of proposals, at least 4", "N")
      ->transform(whole_number())
      ->capture_default_str();
  add("--first-step", walk.first_step,
      fmt::format("Standard deviation of proposals before anything is accepted, {} to {} cells",
                  walk.smallest_step, walk.largest_step),
      "CELLS")
      ->check(kNumber)
      ->capture_default_str();
  add("--patience", walk.patience,
      "Stop after so many proposals without an improvement of the best sample, at any temperature", "N")
      ->transform(whole_number())
      ->capture_default_str();
  add("--least-common-cells", match.least_common_cells,
      "Accept only where so many cells of FIXED are known in both maps", "N")
      ->transform(whole_number(0, std::uint64_t{1} << 40))
      ->capture_default_str();
  add("--seed", walk.seed, "Seed of the first walk; those of the others follow from it", "N")
      ->transform(whole_number())
      ->capture_default_str();
  return added;
}

/// Throws CLI::ValidationError for what no option sees by itself.
void check_walk(const SearchOptions& options) {
  if (!options.up_the_tree())
    throw CLI::ValidationError(
        "--strategy", "joint needs several hypotheses per pair: --search exhaustive, quick or thorough");
  if (options.restarts && static_cast<std::size_t>(*options.restarts) < options.walk.c_locks.size())
    throw CLI::ValidationError("--restarts", "is less than the number of --c-lock, which are used in turn");
  if (!options.scales.empty()) throw CLI::ValidationError("--scale", "excludes --search random-walk");
  if (!options.start.empty() && !options.starts.empty())
    throw CLI::ValidationError("--start", "excludes --starts");
  try {
    validate(options.walk.walk);
  } catch (const std::invalid_argument& error) {
    throw CLI::ValidationError("--search random-walk", error.what());
  }
}

}  // namespace

const CLI::Validator kScales(
    [](std::string& text) {
      const std::optional<ScaleRange> scales = parse_scales(text);
      if (!scales) return "'" + text + "' is not LO:HI, as 0.5:2";
      try {
        validate(*scales);
      } catch (const std::invalid_argument& error) {
        return "'" + text + "': " + error.what();
      }
      return std::string();
    },
    "");

ScaleRange to_scales(const std::string& text) {
  return parse_scales(text).value();
}

void add_search_options(CLI::App& command, SearchOptions& options, const char* exhaustive) {
  std::vector<std::string> names;
  std::string methods;
  for (const SearchMethodName& one : search_methods()) {
    names.emplace_back(one.name);
    const bool is_own = one.method == SearchMethod::exhaustive && exhaustive != nullptr;
    methods +=
        fmt::format("{}{}: {}", methods.empty() ? "" : "; ", one.name, is_own ? exhaustive : one.meaning);
  }
  command.add_option("--search", options.method, methods)
      ->type_name("METHOD")
      ->check(CLI::IsMember(names))
      ->capture_default_str();
  command
      .add_option(
          "--accept", options.accept,
          fmt::format("How sure a match has to be: the smallest probability that is accepted, {} if not "
                      "given. Of the random walk the smallest acceptance index, {} if not given",
                      MatchOptions{}.accept_probability, RandomWalkMatchOptions{}.accept_acceptance_index))
      ->type_name("P")
      ->check(kProbability);
  const std::vector<CLI::Option*> of_walk = add_walk_options(command, options);
  command.parse_complete_callback([&options, of_walk] {
    if (options.random_walk()) {
      check_walk(options);
      return;
    }
    for (const CLI::Option* option : of_walk) {
      if (option->count() > 0) throw CLI::ValidationError(option->get_name(), "needs --search random-walk");
    }
    if (!options.start.empty()) throw CLI::ValidationError("--start", "needs --search random-walk");
    if (!options.trace.empty()) throw CLI::ValidationError("--trace", "needs --search random-walk");
  });
}

void add_start_option(CLI::App& command, SearchOptions& options) {
  command
      .add_option("--start", options.start,
                  "Start here, at this T_fixed_moving in metres and radians, and not at the best "
                  "poses of --starts")
      ->type_name("X,Y,THETA")
      ->group(kWalkGroup)
      ->check(kPose);
}

void add_scale_option(CLI::App& command, SearchOptions& options) {
  command
      .add_option(
          "--scale", options.scales,
          "MOVING may have any scale of this range, as 0.5:2: it is an architect's plan, or FIXED is. "
          "The answer has the scale too: p_fixed = scale * R(theta) * p_moving + (x, y). The metres "
          "of FIXED count. Looks quickly at each scale, which takes seconds, unless --search is "
          "thorough")
      ->type_name("LO:HI")
      ->check(kScales);
}

void add_trace_option(CLI::App& command, SearchOptions& options) {
  CLI::Option* trace =
      command.add_option("--trace", options.trace, "Write every accepted sample to this CSV file")
          ->type_name("FILE")
          ->group(kWalkGroup);
  command.add_flag("--trace-all", options.trace_all, "And every refused one")
      ->group(kWalkGroup)
      ->needs(trace);
}

void add_strategy_option(CLI::App& command, SearchOptions& options) {
  command
      .add_option("--strategy", options.strategy,
                  "joint: what all pairs say together decides; tree: pairwise up a tree, as Birk & Carpin "
                  "(2006). joint if not given, tree with --search random-walk")
      ->type_name("STRATEGY")
      ->check(CLI::IsMember({"joint", "tree"}));
}

MatchOptions match_options(const CommonOptions& common, const SearchOptions& options) {
  MatchOptions engine;
  engine.threads = common.threads;
  engine.accept_probability = options.accept_from();
  if (options.lists_all) engine.max_hypotheses = std::numeric_limits<std::size_t>::max();
  engine.search = search_method(options.method).value();
  if (!options.scales.empty()) engine.scales = to_scales(options.scales);
  return engine;
}

PairMatcher::PairMatcher(const CommonOptions& common, SearchOptions options,
                         std::function<void(double)> progress)
    : common_(common), options_(std::move(options)), progress_(std::move(progress)), trace_(kTraceHead) {}

MatchResult PairMatcher::operator()(const OccupancyGrid& fixed, const OccupancyGrid& moving) {
  ++matches_;
  MatchOptions engine = match_options(common_, options_);
  engine.progress = progress_;
  if (options_.random_walk()) {
    RandomWalkMatchOptions& walk = engine.random_walk;
    walk = options_.walk;
    if (!options_.starts.empty()) walk.start = parse_starts(options_.starts).value();
    if (!options_.start.empty()) walk.start_pose = to_pose(options_.start);
    if (!options_.trace.empty()) walk.walk.trace = options_.trace_all ? WalkTrace::all : WalkTrace::accepted;
    walk.restarts = options_.restarts.value_or(static_cast<int>(walk.c_locks.size()));
    walk.accept_acceptance_index = options_.accept_from();
    if (!options_.trace.empty()) {
      walk.on_walk = [&](int number, double c_lock, const RandomWalkResult& result) {
        record(c_lock, number, result);
      };
    }
  }
  return match(fixed, moving, engine);
}

void PairMatcher::record(double c_lock, int walk, const RandomWalkResult& result) {
  const auto out = std::back_inserter(trace_);
  for (const WalkSample& sample : result.trace) {
    const SE2& T = sample.T_fixed_moving;
    fmt::format_to(out, "{},{},{},{},", matches_, walk + 1, c_lock, sample.step);
    const ImageSimilarity& similarity = sample.similarity;
    if (sample.measured) {
      fmt::format_to(out, "{},{},{},{},", sample.delta, similarity.psi(), similarity.agreement,
                     similarity.disagreement);
    } else {
      fmt::format_to(out, ",,,,");
    }
    fmt::format_to(out, "{},{},{},", T.x, T.y, T.theta);
    if (sample.measured) {
      fmt::format_to(out, "{},{},", similarity.omega, similarity.acceptance_index());
    } else {
      fmt::format_to(out, ",,");
    }
    fmt::format_to(out, "{},{}\n", sample.accepted ? 1 : 0, sample.wide ? 1 : 0);
  }
}

void PairMatcher::write_trace() const {
  if (!options_.trace.empty()) write_file_atomically(options_.trace, trace_);
}

}  // namespace gridmerge::cli
