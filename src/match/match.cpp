// SPDX-License-Identifier: Apache-2.0
#include "gridmerge/match/match.hpp"

#include <algorithm>
#include <chrono>
#include <stdexcept>
#include <utility>

#include "gridmerge/grid/execution.hpp"
#include "match/drawing.hpp"
#include "match/looked_twice.hpp"
#include "match/looks.hpp"
#include "match/match_at_scales.hpp"
#include "match/pair_pose.hpp"
#include "match/prepared_map.hpp"

namespace gridmerge {

using namespace internal;

namespace {

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// Two maps in the order in which they are compared.
struct InOrder {
  InOrder(const PreparedMap& fixed, const PreparedMap& moving)
      : swapped(are_swapped(fixed, moving)), maps(swapped ? moving : fixed, swapped ? fixed : moving) {}

  bool swapped;  // so the answer does not depend on which map the caller called fixed
  ComparedMaps maps;
};

std::vector<Hypothesis> look(const ComparedMaps& maps, const MatchOptions& options,
                             const QuickLook* quick_look = nullptr) {
  // Whoever accepts less than usual is told the same probability: the second look is spared from the same on.
  const double decided_from = std::max(options.accept_probability, LookOptions{}.decided_from);
  return find_hypotheses(maps, {options.search, decided_from, options.progress, quick_look});
}

MatchResult judge(const InOrder& in_order, std::vector<Hypothesis> found, const MatchOptions& options) {
  const ComparedMaps& maps = in_order.maps;
  MatchResult result;
  result.hypotheses = std::move(found);
  result.reason = explain_refusal(figures_of(result.hypotheses), options.accept_probability);
  if (result.hypotheses.empty()) return result;
  const Hypothesis& best = result.hypotheses.front();
  result.T_fixed_moving = best.T_fixed_moving;
  result.probability = best.probability;
  count_common(maps.fixed, maps.moving, result);
  result.verdict = best.probability >= options.accept_probability ? Verdict::accepted : Verdict::refused;
  if (result.hypotheses.size() > options.max_hypotheses) result.hypotheses.resize(options.max_hypotheses);
  return in_order.swapped ? inverse(std::move(result)) : result;
}

void require_prepared_search(const MatchOptions& options) {
  validate(options);
  if (options.search == SearchMethod::random_walk || options.scales)
    throw std::invalid_argument("prepared maps are matched at one scale, and not by the random walk");
}

MatchResult match_prepared(const PreparedMap& fixed, const PreparedMap& moving, const MatchOptions& options,
                           const QuickLook* quick_look = nullptr) {
  require_prepared_search(options);
  const auto start = std::chrono::steady_clock::now();
  const InOrder in_order(fixed, moving);
  MatchResult result = judge(in_order, look(in_order.maps, options, quick_look), options);
  result.seconds = seconds_since(start);
  return result;
}

MatchResult walk(const OccupancyGrid& fixed, const OccupancyGrid& moving, const MatchOptions& options) {
  RandomWalkMatchOptions walk = options.random_walk;
  walk.threads = options.threads;
  walk.max_hypotheses = options.max_hypotheses;
  walk.progress = options.progress;
  return match_by_random_walk(fixed, moving, walk);
}

}  // namespace

MatchResult match(const OccupancyGrid& fixed, const OccupancyGrid& moving, const MatchOptions& options) {
  validate(options);
  if (options.search == SearchMethod::random_walk) return walk(fixed, moving, options);
  const auto start = std::chrono::steady_clock::now();
  MatchResult result;
  if (options.scales) {
    const PreparedMap plan_fixed(with_enclosed_free(fixed)), plan_moving(with_enclosed_free(moving));
    with_threads(options.threads, [&] { result = match_at_scales(plan_fixed, plan_moving, options); });
  } else {
    const PreparedMap prepared_fixed(fixed), prepared_moving(moving);
    with_threads(options.threads, [&] { result = match(prepared_fixed, prepared_moving, options); });
  }
  result.seconds = seconds_since(start);
  if (options.progress) options.progress(1.0);
  return result;
}

MatchResult match(const PreparedMap& fixed, const PreparedMap& moving, const MatchOptions& options) {
  return match_prepared(fixed, moving, options);
}

namespace internal {

QuickMatch match_quickly(const PreparedMap& fixed, const PreparedMap& moving, MatchOptions options) {
  options.search = SearchMethod::quick;
  require_prepared_search(options);
  const auto start = std::chrono::steady_clock::now();
  const InOrder in_order(fixed, moving);
  QuickLook found = look(in_order.maps, options);
  MatchResult result = judge(in_order, found, options);
  result.seconds = seconds_since(start);
  return {std::move(result), std::move(found)};
}

MatchResult match_again(const PreparedMap& fixed, const PreparedMap& moving, MatchOptions options,
                        const QuickLook& found) {
  options.search = SearchMethod::exhaustive;
  return match_prepared(fixed, moving, options, &found);
}

MatchResult match_if_promising(const PreparedMap& fixed, const PreparedMap& moving,
                               const MatchOptions& options, double promising_from) {
  QuickMatch quick = match_quickly(fixed, moving, options);
  if (quick.result.probability < promising_from) return std::move(quick.result);
  const double seconds = quick.result.seconds;
  MatchResult result = match_again(fixed, moving, options, quick.found);
  result.seconds += seconds;
  return result;
}

}  // namespace internal

void validate(const ScaleRange& scales) {
  if (!(scales.least >= kMinScale && scales.most <= kMaxScale && scales.least <= scales.most))
    throw std::invalid_argument("scales must go from a smaller to a larger one, within [0.001, 1000]");
  if (!(scales.most <= kMaxScaleRatio * scales.least))
    throw std::invalid_argument("scales must not differ by more than a factor of 20");
}

void validate(const MatchOptions& options) {
  if (static_cast<std::size_t>(options.search) >= search_methods().size())
    throw std::invalid_argument("there is no such search");
  if (options.scales) {
    validate(*options.scales);
    if (options.search == SearchMethod::random_walk)
      throw std::invalid_argument("scales are not searched by the random walk");
  }
  if (options.search == SearchMethod::random_walk) validate(options.random_walk);
  if (options.threads < 0) throw std::invalid_argument("threads must not be negative");
  if (!(options.accept_probability >= 0.0 && options.accept_probability <= 1.0)) {
    throw std::invalid_argument("accept_probability must lie in [0, 1]");
  }
}

}  // namespace gridmerge
