// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gridmerge/match/match.hpp"

namespace gridmerge::internal {

/// What the engine says of a pose as it stands: its score, its figures, and the probability that
/// refine_pose() would give it. Argument, errors, threads and time as there.
Hypothesis judge_pose(const PreparedMap& fixed, const PreparedMap& moving, const SE2& T_fixed_moving);

}  // namespace gridmerge::internal
