// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gridmerge/grid/occupancy_grid.hpp"
#include "match/bytes.hpp"

namespace gridmerge::python {

/// Every bit of a grid.
void write_grid(const OccupancyGrid& grid, internal::ByteWriter& writer);

/// Throws std::invalid_argument for bytes that are no grid.
OccupancyGrid read_grid(internal::ByteReader& reader);

}  // namespace gridmerge::python
