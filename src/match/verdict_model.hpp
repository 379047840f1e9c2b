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

inline constexpr double kVerdictBias = -16.418;

/// In the order of verdict_terms().
inline constexpr std::array kVerdictWeights{
    VerdictWeight{"lines", 0.560},
    VerdictWeight{"tells apart", 3.000},
    VerdictWeight{"held", 1.097},
    VerdictWeight{"lead", 0.426},
    VerdictWeight{"met locally", 3.624},
    VerdictWeight{"bend explains", 0.641},
    VerdictWeight{"cells agree", 3.202},
    VerdictWeight{"things met", 2.133},
};

}  // namespace gridmerge
