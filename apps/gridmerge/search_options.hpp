// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "gridmerge/match/match.hpp"
#include "gridmerge/match/random_walk_match.hpp"
#include "gridmerge/merge/tree.hpp"
#include "options.hpp"

namespace gridmerge::cli {

/// A range of scales, LO:HI.
extern const CLI::Validator kScales;

/// What a text that kScales lets pass says.
ScaleRange to_scales(const std::string& text);

/// How pairs of maps are matched, and what is accepted.
struct SearchOptions {
  std::string method = name_of(SearchMethod::exhaustive);
  std::optional<double> accept;  // probability, or acceptance index of the random walk
  RandomWalkMatchOptions walk;   // except for what is below
  std::optional<int> restarts;   // one for each c_lock if not given
  std::string starts;            // the lattice, as the command line says it; the usual one if empty
  std::string start;             // a pose instead
  std::string scales;            // LO:HI; scales are not searched if empty
  std::string trace;
  bool trace_all = false;
  bool lists_all = false;               // results hold all poses that were judged
  std::optional<std::string> strategy;  // how several maps are merged

  bool random_walk() const { return method == name_of(SearchMethod::random_walk); }
  double accept_from() const;
  /// Up the paper's tree; it is the random walk's way if none is asked for.
  bool up_the_tree() const { return strategy ? *strategy == "tree" : random_walk(); }
};

/// --search and what belongs to it. Options of the random walk without it are a usage error. `exhaustive`
/// says what that method does in this command, if that is not what it does to one pair.
void add_search_options(CLI::App& command, SearchOptions& options, const char* exhaustive = nullptr);

/// --start: needs add_search_options() of the same command.
void add_start_option(CLI::App& command, SearchOptions& options);

/// --scale: needs add_search_options() of the same command.
void add_scale_option(CLI::App& command, SearchOptions& options);

/// --trace and --trace-all: needs add_search_options() of the same command.
void add_trace_option(CLI::App& command, SearchOptions& options);

/// --strategy: needs add_search_options() of the same command.
void add_strategy_option(CLI::App& command, SearchOptions& options);

/// The options of joint merging and of matching every pair, as the command line gives them.
MatchOptions match_options(const CommonOptions& common, const SearchOptions& options);

/// Matches pairs as the options say, and keeps the walks' traces if they are asked for.
class PairMatcher {
 public:
  /// `progress` gets how much of a match is done, in [0, 1].
  PairMatcher(const CommonOptions& common, SearchOptions options, std::function<void(double)> progress = {});

  MatchResult operator()(const OccupancyGrid& fixed, const OccupancyGrid& moving);

  /// Writes the trace file if there is to be one. Throws FileError.
  void write_trace() const;

 private:
  void record(double c_lock, int walk, const RandomWalkResult& result);

  CommonOptions common_;
  SearchOptions options_;
  std::function<void(double)> progress_;
  int matches_ = 0;
  std::string trace_;
};

}  // namespace gridmerge::cli
