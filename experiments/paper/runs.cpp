// SPDX-License-Identifier: Apache-2.0
#include "runs.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "gridmerge/evaluate/evaluate.hpp"
#include "gridmerge/match/match.hpp"
#include "gridmerge/similarity/image_similarity.hpp"

namespace gridmerge::paper {

namespace {

MatchResult walk(const Pair& pair, const Method& method, std::uint64_t seed, std::size_t& steps) {
  RandomWalkMatchOptions options;
  options.walk.seed = seed;
  options.c_locks = method.c_locks;
  options.restarts = method.walks;
  options.accept_acceptance_index = kAcceptanceIndex;
  options.least_common_cells = 200;  // the hard pair shares fewer than the 400 that are asked for otherwise
  options.threads = 1;
  options.on_walk = [&](int, double, const RandomWalkResult& walked) { steps += walked.proposals; };
  return match_by_random_walk(pair.fixed->map, pair.moving->map, options);
}

MatchResult search(const Pair& pair) {
  MatchOptions options;
  options.threads = 1;
  return match(pair.fixed->map, pair.moving->map, options);
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t middle = values.size() / 2;
  return values.size() % 2 == 1 ? values[middle] : 0.5 * (values[middle - 1] + values[middle]);
}

}  // namespace

Run merge_two(const Pair& pair, const Method& method, std::uint64_t seed) {
  Run run;
  const MatchResult result = method.is_walk() ? walk(pair, method, seed, run.steps) : search(pair);
  run.seconds = result.seconds;
  run.error = rms_displacement(pair.moving->map, result.T_fixed_moving, pair.truth());
  run.accepted = result.verdict == Verdict::accepted;
  run.T_fixed_moving = result.T_fixed_moving;
  if (method.is_walk()) run.c_lock = method.c_locks.back();
  run.found = measure_similarity(pair.fixed->map, pair.moving->map, result.T_fixed_moving);
  run.truth = measure_similarity(pair.fixed->map, pair.moving->map, pair.truth());
  return run;
}

const char* const kRunsHead =
    "| maps | method | steps | ai: median (least–most) | ai at the truth | seconds | error [m] | right poses "
    "| "
    "accepted right | accepted wrong | wrong: search, measure "
    "|\n|---|---|---|---|---|---|---|---|---|---|---|\n";

std::string runs_row(const std::string& pair, const Method& method, const std::vector<Run>& runs) {
  const auto median_of = [&](const auto& value) {
    std::vector<double> values;
    values.reserve(runs.size());
    for (const Run& run : runs) values.push_back(static_cast<double>(value(run)));
    return median(values);
  };
  const auto count = [&](const auto& condition) {
    return std::count_if(runs.begin(), runs.end(), condition);
  };
  const auto ai = [](const Run& run) { return run.found.acceptance_index(); };
  const auto [low, high] = std::minmax_element(runs.begin(), runs.end(),
                                               [&](const Run& a, const Run& b) { return ai(a) < ai(b); });
  const std::string failures =
      method.is_walk() ? fmt::format("{}, {}", count([](const Run& r) { return r.is_search_failure(); }),
                                     count([](const Run& r) { return r.is_measure_failure(); }))
                       : "–";
  return fmt::format(
      "| {} | {} | {} | {:.4f} ({:.4f}–{:.4f}) | {:.4f} | {:.2f} | {:.2f} | {} of {} | {} | {} | {} |\n",
      pair, method.name,
      method.is_walk() ? fmt::format("{:.0f}", median_of([](const Run& r) { return r.steps; })) : "–",
      median_of(ai), ai(*low), ai(*high), median_of([](const Run& r) { return r.truth.acceptance_index(); }),
      median_of([](const Run& r) { return r.seconds; }), median_of([](const Run& r) { return r.error; }),
      count([](const Run& r) { return r.correct(); }), runs.size(),
      count([](const Run& r) { return r.accepted && r.correct(); }),
      count([](const Run& r) { return r.accepted && !r.correct(); }), failures);
}

}  // namespace gridmerge::paper
