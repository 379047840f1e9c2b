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

inline constexpr double kVerdictBias = -14.435;

/// In the order of verdict_terms().
// clang-format off
inline constexpr std::array kVerdictWeights{
    VerdictWeight{"tells apart", 3.000},
    VerdictWeight{"held", 1.000},
    VerdictWeight{"stands out", 0.315},
    VerdictWeight{"far ahead, bent", 8.458},
    VerdictWeight{"met locally", 2.635},
    VerdictWeight{"bend explains", 5.285},
    VerdictWeight{"cells agree", 3.544},
    VerdictWeight{"agrees better", 0.721},
    VerdictWeight{"things met", 1.573},
};
// clang-format on

/// In the order of rank_terms().
// clang-format off
inline constexpr std::array kRankWeights{
    VerdictWeight{"evidence", 3.191},
    VerdictWeight{"seen", 1.764},
    VerdictWeight{"cells", 3.234},
    VerdictWeight{"lines", 2.775},
    VerdictWeight{"things", 2.900},
    VerdictWeight{"tolerance", 1.520},
};
// clang-format on

}  // namespace gridmerge::internal
