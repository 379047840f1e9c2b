// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "gridmerge/grid/occupancy_grid.hpp"
#include "temporary_directory.hpp"

namespace gridmerge::test {

/// The floor of an invented building, 18 m x 13 m, wholly known: rooms of unequal sizes with doors and
/// furniture. Another seed gives another building.
OccupancyGrid draw_building(unsigned seed);

/// A part of the building, in metres of its frame.
struct Window {
  double left, bottom, right, top;
};

/// The map of a robot that saw only `window` and whose frame is placed by T_map_building.
OccupancyGrid map_part(const OccupancyGrid& building, const Window& window, const SE2& T_map_building);

/// The walls of a map, black on white paper with a margin.
OccupancyGrid on_white_paper(const OccupancyGrid& map);

/// Writes <name>.pgm and <name>.yaml (map_server, trinary) and returns the path of the latter. Apart from the
/// library's own writer, so that it can be used to test it.
std::string write_map(const TemporaryDirectory& directory, const std::string& name, const OccupancyGrid& map);

}  // namespace gridmerge::test
