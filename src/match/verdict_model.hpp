// SPDX-License-Identifier: Apache-2.0
// Made by calibration/fit.py; not to be changed by hand.
#pragma once

#include <array>

namespace gridmerge {

/// A term of verdict_terms(), and what it weighs.
struct VerdictWeight {
  const char* term;
  double weight;
};

inline constexpr double kVerdictBias = -18.184;

/// In the order of verdict_terms().
inline constexpr std::array kVerdictWeights{
    VerdictWeight{"walls", 0.341},       VerdictWeight{"lines", 0.000},
    VerdictWeight{"tells apart", 1.000}, VerdictWeight{"held", 0.496},
    VerdictWeight{"met locally", 2.461}, VerdictWeight{"bend explains", 2.319},
    VerdictWeight{"cells agree", 3.927}, VerdictWeight{"things met", 2.821},
};

}  // namespace gridmerge
