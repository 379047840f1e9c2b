// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "similarity/likelihood_field.hpp"

namespace gridmerge::internal {

/// The walls on which two maps agree.
struct WallSupport {
  /// How much structure they have, as a number of equally long straight lines: the exponential of the entropy
  /// of the lines' lengths; 0 when no walls meet. Two maps of a single room's corner agree on 2 lines,
  /// however long: they fit each other wherever there is a corner. Doors, recesses, bends and further rooms
  /// add lines, and with them the ways in which a wrong pose would have failed.
  double lines = 0.0;
  /// How many wall points of the moving map lie on walls of the fixed one that face the same side.
  double met = 0.0;
  /// How far they spread in the direction in which they spread least: standard deviation [cells].
  double spread = 0.0;
};

/// A line is a side of a wall (two sides of a thin one are two lines), given by the direction it faces and
/// its distance from the origin; lines are taken off greedily, most points first (Hough voting). `T` is
/// between grid frames, in cells. O(lines * (walls + diagonal of the fixed map)).
WallSupport measure_wall_support(const LikelihoodField& fixed, const LikelihoodField& moving,
                                 const SE2& T_fixed_moving_cells);

}  // namespace gridmerge::internal
