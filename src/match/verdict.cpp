// SPDX-License-Identifier: Apache-2.0
#include "gridmerge/match/verdict.hpp"

#include <algorithm>
#include <cmath>

namespace gridmerge {

namespace {

// A logistic model. See docs/decisions.md for the pairs that it was fitted to.
constexpr double kLeadWeight = 0.25;
constexpr double kAcceptanceWeight = 95.0;
constexpr double kBias = -93.0;
constexpr double kMaxAcceptance = 0.975;

}  // namespace

VerdictFeatures make_verdict_features(const std::vector<double>& scores, double acceptance_index) {
  VerdictFeatures features;
  features.acceptance_index = acceptance_index;
  if (scores.empty() || scores[0] <= 0.0) return features;
  const double second = scores.size() > 1 ? std::max(0.0, scores[1]) : 0.0;
  features.lead = (scores[0] - second) / std::sqrt(scores[0]);
  return features;
}

double probability_of(const VerdictFeatures& features) {
  if (features.lead <= 0.0) return 0.0;
  // Above this the index says how clean the maps are, not whether they belong together.
  const double index = std::min(features.acceptance_index, kMaxAcceptance);
  const double logit = kBias + kLeadWeight * features.lead + kAcceptanceWeight * index;
  return 1.0 / (1.0 + std::exp(-logit));
}

}  // namespace gridmerge
