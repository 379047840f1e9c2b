// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <numbers>
#include <string>

#include "gridmerge/match/match.hpp"
#include "match/verdict.hpp"

namespace gridmerge {

using namespace internal;

namespace {

constexpr const char* kNotAsSurely = "the maps show one place, but not as surely as is asked for";

/// Refused only because more is asked for than usual: nothing speaks against the maps, and the reason is only
/// what would make them surer still.
bool is_usually_enough(const MatchResult& result, double accept_probability) {
  return result.probability >= MatchOptions{}.accept_probability && result.probability < accept_probability;
}

std::string explain_ambiguous(const MatchResult& result, double accept_probability) {
  const PoseFigures& best = result.hypotheses.front().figures;
  if (slides(best))
    return "the maps are free to slide along " +
           std::to_string(std::lround(180.0 / std::numbers::pi * best.free_direction)) + " degrees";
  if (result.hypotheses.size() > 1 &&
      is_near_rival(result.hypotheses[0].probability, result.hypotheses[1].probability, accept_probability))
    return "another way to lay the maps explains them too well to be ruled out";
  if (stands_out(best, accept_probability))
    return "the maps agree, but on so few walls that other places or scales may fit as well by chance";
  return is_usually_enough(result, accept_probability)
             ? kNotAsSurely
             : "this way to lay the maps hardly stands out from all others";
}

}  // namespace

std::string explain(const MatchResult& result, double accept_probability) {
  if (result.verdict == Verdict::accepted) return "the maps show one place";
  switch (result.reason) {
    case Reason::nothing_to_compare:
      return "there is too little in the maps to compare";
    case Reason::ambiguous:
      if (!result.hypotheses.empty()) return explain_ambiguous(result, accept_probability);
      return "more than one way to lay the maps explains them";
    case Reason::contradiction:
      if (is_usually_enough(result, accept_probability)) break;
      return result.scale == 1.0
                 ? "the maps disagree where both know the same places"
                 : "too few walls meet a wall of the other map where both know the same places";
    case Reason::too_little_overlap:
      return "the maps agree, but on too little to be sure";
    case Reason::several:
    case Reason::contradicts_others:
    case Reason::over_budget:
    case Reason::none:
      break;
  }
  return is_usually_enough(result, accept_probability) ? kNotAsSurely
                                                       : "no way to lay the maps explains them well";
}

}  // namespace gridmerge
