// SPDX-License-Identifier: Apache-2.0
// Made by calibration/fit.py from calibration/fit.tsv; not to be changed by hand.
#pragma once

#include <algorithm>
#include <cmath>

#include "gridmerge/match/verdict.hpp"

namespace gridmerge {

/// The logit of the probability that a best hypothesis with these features is the true pose.
inline double verdict_logit(const VerdictFeatures& f) {
  double logit = -13.8097;
  logit += 0.9727 * std::min(f.lead, 100.0) / 10.0;
  logit += 2.6049 * std::log(std::clamp(f.wall_lines, 1.0, 8.0));
  logit += 6.1711 * -std::log(std::max(1.0 - f.walls_met_locally, 0.05));
  logit += -1.8828 * -std::log(std::max(1.0 - f.walls_met, 0.05));
  return logit;
}

}  // namespace gridmerge
