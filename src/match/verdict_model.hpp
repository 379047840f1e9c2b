// SPDX-License-Identifier: Apache-2.0
// Made by calibration/fit.py; not to be changed by hand.
#pragma once

#include <array>

namespace gridmerge {

/// A term of verdict_terms() or rank_terms(), and what it weighs.
struct VerdictWeight {
  const char* term;
  double weight;
};

inline constexpr double kVerdictBias = -14.982;

/// In the order of verdict_terms().
// clang-format off
inline constexpr std::array kVerdictWeights{
    VerdictWeight{"tells apart", 3.000},
    VerdictWeight{"held", 1.000},
    VerdictWeight{"stands out", 0.487},
    VerdictWeight{"far ahead, bent", 9.962},
    VerdictWeight{"met locally", 2.557},
    VerdictWeight{"bend explains", 2.610},
    VerdictWeight{"cells agree", 3.744},
    VerdictWeight{"agrees better", 1.407},
    VerdictWeight{"things met", 2.193},
};
// clang-format on

/// In the order of rank_terms().
// clang-format off
inline constexpr std::array kRankWeights{
    VerdictWeight{"evidence", 2.996},
    VerdictWeight{"seen", 1.694},
    VerdictWeight{"cells", 3.184},
    VerdictWeight{"lines", 2.641},
    VerdictWeight{"things", 2.726},
    VerdictWeight{"tolerance", 1.288},
};
// clang-format on

}  // namespace gridmerge
