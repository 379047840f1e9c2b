// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gridmerge/similarity/wall_map.hpp"

namespace gridmerge {

/// How much structure the walls have on which two maps agree, as a number of equally long straight lines: the
/// exponential of the entropy of the lines' lengths; 0 when no walls meet. Two maps of a single room's corner
/// agree on 2 lines, however long: they fit each other wherever there is a corner. Doors, recesses, bends and
/// further rooms add lines, and with them the ways in which a wrong pose would have failed.
///
/// A line is a side of a wall (two sides of a thin one are two lines), given by the direction it faces and
/// its distance from the origin; lines are taken off greedily, most points first (Hough voting). `T` is
/// between grid frames, in cells. O(lines * (walls + diagonal of the fixed map)).
double count_wall_lines(const WallMap& fixed, const WallMap& moving, const SE2& T_fixed_moving_cells);

}  // namespace gridmerge
