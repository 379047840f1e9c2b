// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "gridmerge/export.hpp"
#include "gridmerge/grid/occupancy_grid.hpp"

namespace gridmerge {

// Birk & Carpin (2006) compare cells of maps that lie on one lattice. These functions lay maps at poses on
// the lattice of any grid: its size, resolution and origin count, its cells do not. Each cell takes the value
// of the map's cell in which its centre falls (nearest cell), and is unknown where there is none. A centre
// that falls on the edge between two cells, to about a millionth of a cell, may go to either.
//
// All throw std::invalid_argument for invalid grids, resolutions that differ by more than 100 times, sides of
// more than a million cells, and a transform that is not finite or puts the map that far away.

/// T(m), the map that a transform makes of a map (definition 4 of the paper), on `lattice`: a grid of its
/// size, resolution and origin. `map.T_output_map` takes the map's frame to the lattice's [m, rad].
/// Probabilities are dropped. O(cells of the lattice).
GRIDMERGE_EXPORT OccupancyGrid draw_on_lattice(const OccupancyGrid& lattice, const PlacedMap& map);

/// omega for k maps at poses (eq. 3): cells of the lattice at which all of them have the same value, unknown
/// included. The order of the maps plays no part. Every cell counts for a single map, none for no map.
/// O(k * cells of the lattice).
GRIDMERGE_EXPORT std::int64_t count_equal_cells(const OccupancyGrid& lattice,
                                                std::span<const PlacedMap> maps);

/// Whether the rectangles that hold the maps' known cells share a cell of the fixed map's lattice: the maps
/// can have something in common only then. False for a transform that is not finite or puts the maps more
/// than a million cells apart. Throws for the grids as above. O(cells of both).
GRIDMERGE_EXPORT bool lie_on_each_other(const OccupancyGrid& fixed, const OccupancyGrid& moving,
                                        const SE2& T_fixed_moving);

}  // namespace gridmerge
