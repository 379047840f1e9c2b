// SPDX-License-Identifier: Apache-2.0
#include "match/scale.hpp"

#include <algorithm>
#include <utility>

#include "grid/longer_side.hpp"
#include "match/scaled_pose.hpp"

namespace gridmerge::internal {

namespace {

constexpr double kMinProbability = 0.99;

/// A map that was scaled to this or that side [m] shows no place to compare.
constexpr double kMinSide = 2.0;
constexpr double kMaxSide = 1000.0;

}  // namespace

std::optional<ScaleFound> find_scale(const OccupancyGrid& fixed, const OccupancyGrid& moving,
                                     const MatchOptions& options) {
  MatchOptions asked = options;
  asked.accept_probability = std::max(options.accept_probability, kMinProbability);
  asked.progress = nullptr;
  asked.search = SearchMethod::quick;  // a hint is not worth more time than the answer took
  const double side = longer_side(moving);
  std::optional<ScaleFound> best;
  for (const double factor : {2.0, 0.5, 2.5, 0.4, 4.0, 0.25, 5.0, 0.2, 10.0, 0.1}) {
    if (factor * side < kMinSide || factor * side > kMaxSide || !is_scalable(moving, factor)) continue;
    const MatchResult result = match(fixed, scaled(moving, factor), asked);
    if (result.verdict != Verdict::accepted) continue;
    if (!best || result.probability > best->probability) best = ScaleFound{factor, result.probability};
  }
  return best;
}

}  // namespace gridmerge::internal
