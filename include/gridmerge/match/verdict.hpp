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
  double wall_lines = 0.0;        ///< count_wall_lines() of the best hypothesis
};

/// (best - second) / sqrt(best), from the scores of distinct hypotheses, best first, all positive.
double find_lead(const std::vector<double>& scores);

/// Probability that the best hypothesis is the true pose. Rises with every feature. Without a lead it is
/// about 1/2 at most: another hypothesis is as good.
double probability_of(const VerdictFeatures& features);

}  // namespace gridmerge
