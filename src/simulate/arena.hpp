// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "simulate/draughtsman.hpp"
#include "simulate/random.hpp"

namespace gridmerge::internal {

/// An arena in a frame with its middle at the origin.
struct Arena {
  int folds = 2;                        ///< turned by 1 / folds of a turn, `symmetric` lies on itself exactly
  std::vector<Edge> symmetric;          ///< walls, blocks and pillars
  std::vector<std::vector<Edge>> lone;  ///< 0 to 5 pillars that lie on nothing when they are turned
};

/// Of `width` x `height` metres, or, if it is fourfold, a square of the shorter side.
Arena make_arena(Random& random, double width, double height);

}  // namespace gridmerge::internal
