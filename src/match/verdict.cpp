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

}  // namespace gridmerge
