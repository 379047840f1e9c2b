// SPDX-License-Identifier: Apache-2.0
#include "match/flaw.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <stdexcept>
#include <string>

namespace gridmerge {

namespace {

/// [m] Map frames lie no further apart, at whatever scale. Squares of numbers far larger are not finite.
constexpr double kFarthest = 1e13;

bool is_sound(const SE2& T, double probability) {
  return is_finite(T) && std::max(std::abs(T.x), std::abs(T.y)) <= kFarthest && probability >= 0.0 &&
         probability <= 1.0;
}

bool is_sound(double scale) {
  return std::isfinite(scale) && scale > 0.0;
}

bool is_sound(const PoseFigures& figures) {
  const std::span<const PoseFigure> all = pose_figures();
  return figures.sigma >= 0.0 && std::all_of(all.begin(), all.end(), [&](const PoseFigure& one) {
           return std::isfinite(figures.*one.value);
         });
}

const char* flaw_of(const Hypothesis& one) {
  if (!is_sound(one.T_fixed_moving, one.probability)) return "holds a pose that no match has";
  if (!is_sound(one.scale)) return "holds a scale that no match has";
  return std::isfinite(one.score) && is_sound(one.figures) ? nullptr : "holds a figure that no match has";
}

}  // namespace

const char* internal::flaw_of(const PairPose& pose) {
  if (!is_sound(pose.T_fixed_moving, pose.probability)) return "holds a pose that no match has";
  const bool is_counted = std::isfinite(pose.acceptance_index) && pose.agreement >= 0 &&
                          pose.disagreement >= 0 && pose.overlap >= 0.0 && std::isfinite(pose.overlap);
  return is_counted ? nullptr : "holds a comparison that no match has";
}

const char* internal::flaw_of(const MatchResult& match) {
  if (const char* flaw = flaw_of(static_cast<const PairPose&>(match))) return flaw;
  if (static_cast<unsigned>(match.verdict) > static_cast<unsigned>(Verdict::accepted) ||
      static_cast<unsigned>(match.reason) > static_cast<unsigned>(Reason::over_budget))
    return "holds a verdict that no match has";
  if (!is_sound(match.scale)) return "holds a scale that no match has";
  for (const Hypothesis& one : match.hypotheses) {
    if (const char* flaw = gridmerge::flaw_of(one)) return flaw;
  }
  return nullptr;
}

void validate(const MatchResult& match) {
  if (const char* flaw = internal::flaw_of(match))
    throw std::invalid_argument(std::string("the match ") + flaw);
}

}  // namespace gridmerge
