// SPDX-License-Identifier: Apache-2.0
// Made by calibration/fit_plans.py; not to be changed by hand.
#pragma once

#include <array>

#include "match/verdict_model.hpp"

namespace gridmerge::internal {

inline constexpr double kScaledBias = -20.21;

/// In the order of the terms of scaled_model().
// clang-format off
inline constexpr std::array kScaledWeights{
    VerdictWeight{"tells apart", 5.06},
    VerdictWeight{"held", 1.00},
    VerdictWeight{"stands out", 0.65},
    VerdictWeight{"met locally", 6.00},
};

/// In the order of the rank terms of scaled_model().
inline constexpr std::array kScaledRankWeights{
    VerdictWeight{"evidence", 5.10},
    VerdictWeight{"seen", 2.24},
    VerdictWeight{"lines", 1.91},
};
// clang-format on

}  // namespace gridmerge::internal
