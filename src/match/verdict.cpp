// SPDX-License-Identifier: Apache-2.0
#include "gridmerge/match/verdict.hpp"

#include <algorithm>
#include <cmath>

namespace gridmerge {

namespace {

// A logistic model. See docs/decisions.md for the pairs that it was fitted to.
constexpr double kLeadWeight = 0.25;
constexpr double kAcceptanceWeight = 95.0;
constexpr double kBias = -92.6;
constexpr double kMaxAcceptance = 0.975;
/// With fewer lines of wall the maps agree on too little: a corner fits every corner, a corridor every
/// corridor.
constexpr double kEnoughLines = 5.0;
constexpr double kLinesWeight = 14.0;

}  // namespace

double find_lead(const std::vector<double>& scores) {
  if (scores.empty() || scores[0] <= 0.0) return 0.0;
  const double second = scores.size() > 1 ? std::max(0.0, scores[1]) : 0.0;
  return (scores[0] - second) / std::sqrt(scores[0]);
}

double probability_of(const VerdictFeatures& features) {
  // Above this the index says how clean the maps are, not whether they belong together.
  const double index = std::min(features.acceptance_index, kMaxAcceptance);
  const double lines = std::clamp(features.wall_lines, 1.0, kEnoughLines) / kEnoughLines;
  const double logit =
      kBias + kLeadWeight * features.lead + kAcceptanceWeight * index + kLinesWeight * std::log(lines);
  return 1.0 / (1.0 + std::exp(-logit));
}

Reason explain_refusal(const VerdictFeatures& features, double accept_probability) {
  if (probability_of(features) >= accept_probability) return Reason::none;
  // What a pair beyond doubt has of each.
  constexpr double kClearLead = 20.0;
  constexpr double kClearIndex = 0.97;
  constexpr double kClearLines = 8.0;
  const auto would_do = [&](double lead, double index, double lines) {
    VerdictFeatures better = features;
    better.lead = std::max(features.lead, lead);
    better.acceptance_index = std::max(features.acceptance_index, index);
    better.wall_lines = std::max(features.wall_lines, lines);
    return probability_of(better) >= accept_probability;
  };
  if (would_do(kClearLead, 0.0, 0.0)) return Reason::ambiguous;
  if (would_do(0.0, kClearIndex, 0.0)) return Reason::contradiction;
  if (would_do(0.0, 0.0, kClearLines)) return Reason::too_little_overlap;
  return Reason::several;
}

const char* name_of(Verdict verdict) {
  return verdict == Verdict::accepted ? "accepted" : "refused";
}

const char* name_of(Reason reason) {
  switch (reason) {
    case Reason::nothing_to_compare:
      return "nothing_to_compare";
    case Reason::ambiguous:
      return "ambiguous";
    case Reason::contradiction:
      return "contradiction";
    case Reason::too_little_overlap:
      return "too_little_overlap";
    case Reason::several:
      return "several";
    case Reason::none:
      break;
  }
  return "none";
}

}  // namespace gridmerge
