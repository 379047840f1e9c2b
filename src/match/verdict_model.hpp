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

inline constexpr double kVerdictBias = -14.950;

/// In the order of verdict_terms().
// clang-format off
inline constexpr std::array kVerdictWeights{
    VerdictWeight{"tells apart", 3.000},
    VerdictWeight{"held", 1.000},
    VerdictWeight{"lead", 0.610},
    VerdictWeight{"far ahead, bent", 12.000},
    VerdictWeight{"met locally", 2.712},
    VerdictWeight{"bend explains", 2.018},
    VerdictWeight{"cells agree", 3.004},
    VerdictWeight{"agrees better", 4.551},
    VerdictWeight{"things met", 2.537},
};
// clang-format on

}  // namespace gridmerge
