// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "gridmerge/grid/se2.hpp"

namespace gridmerge::example {

/// A straight edge that stops a laser beam. Metres, in the building's frame.
struct Edge {
  Point2 a;
  Point2 b;
  double echo = 1.0;  ///< probability that a beam which meets the edge ends there; glass lets most pass
};

using Building = std::vector<Edge>;

/// An office floor, 40 m x 25 m: a corridor, a lobby, rooms of many sizes, and what stands in them.
Building office_floor();

/// A workshop, 27 m x 17 m, which has nothing in common with the office floor.
Building workshop();

}  // namespace gridmerge::example
