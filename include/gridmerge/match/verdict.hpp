// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

namespace gridmerge {

/// What the probability rests on.
struct VerdictFeatures {
  double best_score = 0.0;  ///< evidence of the best hypothesis [nats]
  double margin = 0.0;  ///< 1 - second-best distinct hypothesis / best, in [0, 1]; 1 when there is no second
};

/// From the scores of distinct hypotheses, best first.
VerdictFeatures make_verdict_features(const std::vector<double>& scores);

/// Probability that the best hypothesis is the true pose. Rises with the margin and with the score.
double probability_of(const VerdictFeatures& features);

}  // namespace gridmerge
