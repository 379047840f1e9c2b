// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "simulate/draughtsman.hpp"

namespace gridmerge::example {

using Building = std::vector<Edge>;

/// An office floor, 40 m x 25 m: a corridor, a lobby, rooms of many sizes, and what stands in them.
Building office_floor();

/// A workshop, 27 m x 17 m, which has nothing in common with the office floor.
Building workshop();

}  // namespace gridmerge::example
