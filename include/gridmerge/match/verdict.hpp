// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

namespace gridmerge {

/// What the probability rests on.
struct VerdictFeatures {
  /// (best - second) / sqrt(best), of the scores of distinct hypotheses [sqrt(nats)]; the second counts 0
  /// when there is none. A score is a sum over many places, so chance moves it by about its square root.
  double lead = 0.0;
  double acceptance_index = 0.0;  ///< of the best hypothesis
};

/// From the scores of distinct hypotheses, best first, all positive. No hypothesis has no lead.
VerdictFeatures make_verdict_features(const std::vector<double>& scores, double acceptance_index);

/// Probability that the best hypothesis is the true pose. Rises with both features; 0 without a lead.
double probability_of(const VerdictFeatures& features);

}  // namespace gridmerge
