// SPDX-License-Identifier: Apache-2.0
// Made by calibration/fit_plans.py; not to be changed by hand.
#pragma once

#include <array>

#include "match/verdict_model.hpp"

namespace gridmerge::internal {

inline constexpr double kScaledBias = -14.09;

/// In the order of the terms of scaled_model().
// clang-format off
inline constexpr std::array kScaledWeights{
    VerdictWeight{"tells apart", 3.24},
    VerdictWeight{"held", 2.32},
    VerdictWeight{"stands out", 0.90},
    VerdictWeight{"met locally", 4.43},
};

/// In the order of the rank terms of scaled_model().
inline constexpr std::array kScaledRankWeights{
    VerdictWeight{"evidence", 4.74},
    VerdictWeight{"seen", -0.21},
    VerdictWeight{"lines", 2.38},
};
// clang-format on

}  // namespace gridmerge::internal
