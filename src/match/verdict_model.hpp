// SPDX-License-Identifier: Apache-2.0
// Made by calibration/fit.py from calibration/fit.tsv; not to be changed by hand.
#pragma once

#include <algorithm>
#include <cmath>

#include "gridmerge/match/verdict.hpp"

namespace gridmerge {

/// The logit of the probability that a best hypothesis with these features is the true pose.
inline double verdict_logit(const VerdictFeatures& f) {
  double logit = -18.6939;
  logit += 0.9857 * std::min(f.lead, 100.0) / 10.0;
  logit += 2.3106 * -std::log(1.0 - std::min(f.acceptance_index, 0.985));
  logit += 3.2880 * std::log(std::clamp(f.wall_lines, 1.0, 8.0));
  logit += 2.4183 * -std::log(std::max(f.outliers, 0.05));
  return logit;
}

}  // namespace gridmerge
