// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

namespace gridmerge::internal {

/// The probability of these log-odds [nats].
inline double logistic(double log_odds) {
  return 1.0 / (1.0 + std::exp(-log_odds));
}

}  // namespace gridmerge::internal
