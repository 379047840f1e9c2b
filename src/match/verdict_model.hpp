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

inline constexpr double kVerdictBias = -14.380;

/// In the order of verdict_terms().
// clang-format off
inline constexpr std::array kVerdictWeights{
    VerdictWeight{"tells apart", 3.000},
    VerdictWeight{"held", 1.000},
    VerdictWeight{"stands out", 0.414},
    VerdictWeight{"far ahead, bent", 7.600},
    VerdictWeight{"met locally", 0.955},
    VerdictWeight{"bend explains", 6.293},
    VerdictWeight{"cells agree", 3.313},
    VerdictWeight{"things met", 1.679},
    VerdictWeight{"explained", 1.823},
};
// clang-format on

/// In the order of rank_terms().
// clang-format off
inline constexpr std::array kRankWeights{
    VerdictWeight{"evidence", 2.764},
    VerdictWeight{"uncontradicted", 2.373},
    VerdictWeight{"cells", 2.492},
    VerdictWeight{"lines", 2.895},
    VerdictWeight{"held", 0.607},
    VerdictWeight{"things", 2.307},
    VerdictWeight{"tolerance", 1.927},
};
// clang-format on

}  // namespace gridmerge::internal
