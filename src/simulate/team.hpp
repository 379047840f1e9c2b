// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stdexcept>
#include <vector>

#include "gridmerge/simulate/simulate.hpp"
#include "simulate/explore.hpp"
#include "simulate/random.hpp"
#include "simulate/visit.hpp"

namespace gridmerge::internal {

/// Who starts where, what the building is like then, and how far each goes.
struct Team {
  std::vector<Errand> errands;
  std::vector<Visit> visits;
};

/// Whether an overlap is as good as the one wanted.
bool is_near_enough(double overlap, double wanted);

/// Says what cannot be had, and what could.
std::invalid_argument no_such_overlap(double wanted, double nearest);

/// `plan` is that of the empty building. Throws std::invalid_argument for starts where no robot can stand and
/// an overlap that cannot be had.
Team plan_team(const SimulateOptions& options, const Building& building, const FloorPlan& plan,
               Random& random);

}  // namespace gridmerge::internal
