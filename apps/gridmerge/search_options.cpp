// SPDX-License-Identifier: Apache-2.0
#include "search_options.hpp"

#include <fmt/format.h>

#include <iterator>
#include <utility>

#include "gridmerge/io/atomic_file.hpp"

namespace gridmerge::cli {

namespace {

constexpr const char* kTraceHead = "match,walk,c_lock,step,delta,psi,agr,dis,x,y,theta\n";

}  // namespace

double SearchOptions::accept_from() const {
  const double usual =
      random_walk() ? RandomWalkMatchOptions{}.accept_acceptance_index : MatchOptions{}.accept_probability;
  return accept.value_or(usual);
}

void add_search_options(CLI::App& command, SearchOptions& options) {
  command
      .add_option("--search", options.method,
                  "exhaustive: every pose; random-walk: the walk of Birk & Carpin (2006)")
      ->type_name("METHOD")
      ->check(CLI::IsMember({"exhaustive", "random-walk"}))
      ->capture_default_str();
  command
      .add_option(
          "--accept", options.accept,
          fmt::format("Accept from this probability on, {} if not given; of the random walk from this "
                      "acceptance index on, {} if not given",
                      MatchOptions{}.accept_probability, RandomWalkMatchOptions{}.accept_acceptance_index))
      ->type_name("P")
      ->check(kProbability);
  CLI::Option* c_lock = command
                            .add_option("--c-lock", options.c_locks,
                                        "Random walk: weight of disagreement less agreement, 0 if not given; "
                                        "several, with commas, are used "
                                        "in turn")
                            ->type_name("C,...")
                            ->allow_extra_args(false)  // or it would take the maps behind it
                            ->delimiter(',')
                            ->check(kNotNegative);
  CLI::Option* restarts =
      command
          .add_option("--restarts", options.restarts,
                      "Random walk: how many walks, the best is kept; one for each c_lock if not given")
          ->type_name("N")
          ->check(CLI::Range(1, 1000).description(""));
  CLI::Option* temperature = command
                                 .add_option("--temperature", options.temperature,
                                             "Random walk: a sample whose Delta is worse by d is accepted "
                                             "with probability exp(-d/T); 0 climbs")
                                 ->type_name("T")
                                 ->check(kNotNegative)
                                 ->capture_default_str();
  CLI::Option* seed =
      command
          .add_option("--seed", options.seed,
                      "Random walk: seed of the first walk; those of the others follow from it")
          ->type_name("N")
          ->check(kWholeNumber)
          ->capture_default_str();
  command.parse_complete_callback([&options, c_lock, restarts, temperature, seed] {
    if (options.random_walk()) {
      if (!options.up_the_tree())
        throw CLI::ValidationError("--strategy",
                                   "joint needs several hypotheses a pair: --search exhaustive");
      if (options.restarts && static_cast<std::size_t>(*options.restarts) < options.c_locks.size())
        throw CLI::ValidationError("--restarts",
                                   "is less than the number of --c-lock, which are used in turn");
      return;
    }
    for (const CLI::Option* option : {c_lock, restarts, temperature, seed}) {
      if (option->count() > 0) throw CLI::ValidationError(option->get_name(), "needs --search random-walk");
    }
    if (!options.trace.empty()) throw CLI::ValidationError("--trace", "needs --search random-walk");
  });
}

void add_trace_option(CLI::App& command, SearchOptions& options) {
  command.add_option("--trace", options.trace, "Random walk: write every accepted sample to this CSV file")
      ->type_name("FILE");
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
  return engine;
}

PairMatcher::PairMatcher(const CommonOptions& common, SearchOptions options,
                         std::function<void(double)> progress)
    : common_(common), options_(std::move(options)), progress_(std::move(progress)), trace_(kTraceHead) {}

MatchResult PairMatcher::operator()(const OccupancyGrid& fixed, const OccupancyGrid& moving) {
  ++matches_;
  if (!options_.random_walk()) {
    MatchOptions engine = match_options(common_, options_);
    engine.progress = progress_;
    return match(fixed, moving, engine);
  }
  RandomWalkMatchOptions engine;
  engine.walk.seed = options_.seed;
  engine.walk.record_trace = !options_.trace.empty();
  engine.c_locks = options_.c_locks;
  engine.restarts = options_.restarts.value_or(static_cast<int>(options_.c_locks.size()));
  engine.walk.temperature = options_.temperature;
  engine.accept_acceptance_index = options_.accept_from();
  engine.threads = common_.threads;
  if (progress_) engine.progress = [&](int done, int all) { progress_(static_cast<double>(done) / all); };
  if (engine.walk.record_trace) {
    engine.on_walk = [&](int walk, double c_lock, const RandomWalkResult& result) {
      record(c_lock, walk, result);
    };
  }
  return match_by_random_walk(fixed, moving, engine);
}

void PairMatcher::record(double c_lock, int walk, const RandomWalkResult& result) {
  for (const WalkSample& sample : result.trace) {
    const SE2& T = sample.T_fixed_moving;
    fmt::format_to(std::back_inserter(trace_), "{},{},{},{},{},{},{},{},{},{},{}\n", matches_, walk + 1,
                   c_lock, sample.step, sample.delta, sample.psi, sample.agreement, sample.disagreement, T.x,
                   T.y, T.theta);
  }
}

void PairMatcher::write_trace() const {
  if (!options_.trace.empty()) write_file_atomically(options_.trace, trace_);
}

}  // namespace gridmerge::cli
