// SPDX-License-Identifier: Apache-2.0
#include "gridmerge/evaluate/evaluate.hpp"

#include <algorithm>
#include <new>
#include <set>
#include <stdexcept>

#include "evaluate/count.hpp"
#include "evaluate/map_cache.hpp"
#include "gridmerge/bag/bag.hpp"

namespace gridmerge {

using namespace internal;

namespace {

/// Calls `read` of a map, and tells which line asked for it when that fails.
template <typename Read>
auto named(const TruthMap& map, const Read& read) {
  try {
    return read();
  } catch (const FileError& error) {
    if (map.named_at.empty()) throw;
    throw FileError(std::string(error.what()) + " (" + map.named_at + " names it)");
  }
}

constexpr const char* kNoMemory = "out of memory: maps of larger cells take less";

LoadOptions of_named_files(LoadOptions options) {
  options.regular_files_only = true;
  return options;
}

class Evaluator {
 public:
  Evaluator(const Truth& truth, const EvaluateOptions& options)
      : options_(options),
        maps_(of_named_files(options.load), options.cache_bytes, options.warn),
        total_(truth.pairs.size() + truth.negatives.size() + truth.sets.size()) {
    if (!options_.matcher) {
      options_.matcher = [](const OccupancyGrid& fixed, const OccupancyGrid& moving) {
        return match(fixed, moving);
      };
    }
    if (!options_.merger) {
      options_.merger = [](const std::vector<OccupancyGrid>& grids) { return merge(grids); };
    }
  }

  MatchOutcome evaluate_pair(const TruePair& pair) {
    const auto fixed = get(pair.fixed);
    const auto moving = get(pair.moving);
    const MatchResult result = match_named(pair.fixed, *fixed, pair.moving, *moving);
    MatchOutcome outcome = describe(pair.fixed, pair.moving, result);
    outcome.tier = pair.tier;
    outcome.tolerance = pair.tolerance;
    const auto error_of = [&](const SE2& T_fixed_moving) {
      return rms_displacement(moving->moments, T_fixed_moving, pair.T_fixed_moving);
    };
    if (!result.hypotheses.empty()) outcome.error = error_of(result.T_fixed_moving);
    for (JudgedHypothesis& judged : outcome.hypotheses)
      judged.error = error_of(judged.hypothesis.T_fixed_moving);
    return outcome;
  }

  MatchOutcome evaluate_negative(const NegativePair& pair) {
    const auto fixed = get(pair.fixed);
    const auto moving = get(pair.moving);
    return describe(pair.fixed, pair.moving, match_named(pair.fixed, *fixed, pair.moving, *moving));
  }

  SetOutcome evaluate_set(const TrueSet& set) {
    std::vector<OccupancyGrid> grids;
    std::vector<KnownMoments> moments;
    for (const TrueMember& member : set.members) {
      EvaluatedMap map = named(member.map, [&] { return maps_.read(member.map.path); });
      grids.push_back(std::move(map.grid));
      moments.push_back(map.moments);
    }
    try {
      return judge_set(set, moments, options_.merger(grids));
    } catch (const std::invalid_argument& error) {
      throw std::runtime_error("set " + set.name + ": " + error.what());
    } catch (const std::bad_alloc&) {
      throw std::runtime_error("set " + set.name + ": " + kNoMemory);
    }
  }

  void report_one_done() {
    ++done_;
    if (options_.progress) options_.progress(done_, total_);
  }

 private:
  std::shared_ptr<const EvaluatedMap> get(const TruthMap& map) {
    return named(map, [&] { return maps_.get(map.path); });
  }

  MatchResult match_named(const TruthMap& fixed, const EvaluatedMap& fixed_map, const TruthMap& moving,
                          const EvaluatedMap& moving_map) const {
    const auto failed = [&](const char* why) {
      return std::runtime_error(fixed.path.string() + " and " + moving.path.string() + ": " + why);
    };
    try {
      return options_.matcher(fixed_map.grid, moving_map.grid);
    } catch (const std::invalid_argument& error) {
      throw failed(error.what());
    } catch (const std::bad_alloc&) {
      throw failed(kNoMemory);
    }
  }

  static MatchOutcome describe(const TruthMap& fixed, const TruthMap& moving, const MatchResult& result) {
    MatchOutcome outcome;
    outcome.fixed = fixed.name;
    outcome.moving = moving.name;
    outcome.verdict = result.verdict;
    outcome.probability = result.probability;
    outcome.seconds = result.seconds;
    outcome.reason = result.reason;
    for (const Hypothesis& hypothesis : result.hypotheses) outcome.hypotheses.push_back({hypothesis, {}});
    return outcome;
  }

  EvaluateOptions options_;
  MapCache maps_;
  std::size_t total_;
  std::size_t done_ = 0;
};

}  // namespace

std::vector<std::filesystem::path> input_files(const Truth& truth) {
  std::set<std::filesystem::path> maps, files;
  const auto add = [&](const TruthMap& map) {
    if (!maps.insert(map.path).second) return;
    for (const std::filesystem::path& file :
         named(map, [&] { return any_map_files(map.path, of_named_files({})); }))
      files.insert(file);
  };
  for (const TruePair& pair : truth.pairs) {
    add(pair.fixed);
    add(pair.moving);
  }
  for (const NegativePair& pair : truth.negatives) {
    add(pair.fixed);
    add(pair.moving);
  }
  for (const TrueSet& set : truth.sets) {
    for (const TrueMember& member : set.members) add(member.map);
  }
  return {files.begin(), files.end()};
}

Evaluation evaluate(const Truth& truth, const EvaluateOptions& options) {
  Evaluator evaluator(truth, options);
  Evaluation evaluation;
  for (const TruePair& pair : truth.pairs) {
    evaluation.matches.push_back(evaluator.evaluate_pair(pair));
    evaluator.report_one_done();
  }
  for (const NegativePair& pair : truth.negatives) {
    evaluation.matches.push_back(evaluator.evaluate_negative(pair));
    evaluator.report_one_done();
  }
  for (const TrueSet& set : truth.sets) {
    evaluation.sets.push_back(evaluator.evaluate_set(set));
    evaluator.report_one_done();
  }
  return evaluation;
}

}  // namespace gridmerge
