// SPDX-License-Identifier: Apache-2.0
#include "gridmerge/match/verdict.hpp"

#include <algorithm>
#include <cmath>

namespace gridmerge {

VerdictFeatures make_verdict_features(const std::vector<double>& scores) {
  VerdictFeatures features;
  if (scores.empty() || scores.front() <= 0.0) return features;
  features.best_score = scores.front();
  features.margin = scores.size() < 2 ? 1.0 : std::clamp(1.0 - scores[1] / scores[0], 0.0, 1.0);
  return features;
}

double probability_of(const VerdictFeatures& features) {
  if (features.best_score <= 0.0) return 0.0;
  return features.margin;
}

}  // namespace gridmerge
