// SPDX-License-Identifier: Apache-2.0
// Made by calibration/fit.py from calibration/fit.tsv; not to be changed by hand.
#pragma once

#include <algorithm>
#include <cmath>

#include "gridmerge/match/verdict.hpp"

namespace gridmerge {

/// The logit of the probability that a best hypothesis with these features is the true pose.
inline double verdict_logit(const VerdictFeatures& f) {
  double logit = -13.7994;
  logit += 0.9747 * std::min(f.lead, 100.0) / 10.0;
  logit += 2.5968 * std::log(std::clamp(f.wall_lines, 1.0, 8.0));
  logit += 6.1672 * -std::log(std::max(1.0 - f.walls_met_locally, 0.05));
  logit += -1.8795 * -std::log(std::max(1.0 - f.walls_met, 0.05));
  return logit;
}

}  // namespace gridmerge
