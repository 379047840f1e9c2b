// SPDX-License-Identifier: Apache-2.0
// Made by calibration/fit.py; not to be changed by hand.
#pragma once

#include <array>

namespace gridmerge::internal {

/// A term of verdict_terms() or rank_terms(), and what it weighs.
struct VerdictWeight {
  const char* term;
  double weight;
};

inline constexpr double kVerdictBias = -14.301;

/// In the order of verdict_terms().
// clang-format off
inline constexpr std::array kVerdictWeights{
    VerdictWeight{"tells apart", 3.000},
    VerdictWeight{"held", 1.000},
    VerdictWeight{"stands out", 0.403},
    VerdictWeight{"far ahead, bent", 11.911},
    VerdictWeight{"met locally", 2.560},
    VerdictWeight{"bend explains", 2.675},
    VerdictWeight{"cells agree", 3.559},
    VerdictWeight{"agrees better", 0.806},
    VerdictWeight{"things met", 1.926},
};
// clang-format on

/// In the order of rank_terms().
// clang-format off
inline constexpr std::array kRankWeights{
    VerdictWeight{"evidence", 2.770},
    VerdictWeight{"seen", 1.448},
    VerdictWeight{"cells", 3.268},
    VerdictWeight{"lines", 2.620},
    VerdictWeight{"things", 2.951},
    VerdictWeight{"tolerance", 1.355},
};
// clang-format on

}  // namespace gridmerge::internal
