// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "gridmerge/match/match_result.hpp"

namespace gridmerge::internal {

void weigh_scaled(std::vector<Hypothesis>& hypotheses, std::size_t levels,
                  const std::function<bool(const Hypothesis&, const Hypothesis&)>& are_near);

Reason explain_scaled_refusal(const std::vector<Hypothesis>& hypotheses, double accept_probability);

}  // namespace gridmerge::internal
