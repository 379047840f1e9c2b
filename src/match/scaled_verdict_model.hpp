// SPDX-License-Identifier: Apache-2.0
// Made by calibration/fit_plans.py; not to be changed by hand.
#pragma once

#include <array>

#include "match/verdict_model.hpp"

namespace gridmerge::internal {

inline constexpr double kScaledBias = -10.0;

/// In the order of the terms of scaled_model().
// clang-format off
inline constexpr std::array kScaledWeights{
    VerdictWeight{"tells apart", 1.0},
    VerdictWeight{"held", 1.0},
    VerdictWeight{"stands out", 0.5},
    VerdictWeight{"met locally", 2.0},
};

/// In the order of the rank terms of scaled_model().
inline constexpr std::array kScaledRankWeights{
    VerdictWeight{"evidence", 2.67},
    VerdictWeight{"seen", -0.54},
    VerdictWeight{"lines", 1.2},
    VerdictWeight{"met locally", 1.93},
};
// clang-format on

}  // namespace gridmerge::internal
