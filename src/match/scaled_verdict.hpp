// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "gridmerge/match/match_result.hpp"
#include "match/verdict.hpp"

namespace gridmerge::internal {

/// The model of poses that were found at any of `levels` scales. It differs from rigid_model() for two
/// reasons: more freedom fits by chance more often, and a plan shows no things. The more levels, the less is
/// believed.
VerdictModel scaled_model(std::size_t levels);

/// Gives each its probability, and sorts by it, best first: as weigh(), by scaled_model(). Poses that are
/// near each other are no rivals, as in compare_rivals().
void weigh_scaled(std::vector<Hypothesis>& hypotheses, std::size_t levels,
                  const std::function<bool(const Hypothesis&, const Hypothesis&)>& are_near);

}  // namespace gridmerge::internal
