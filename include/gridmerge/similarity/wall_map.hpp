// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "gridmerge/grid/occupancy_grid.hpp"

namespace gridmerge {

/// Distances to the nearest wall are counted in whole cells: 0, 1, ... kDistanceBins - 2, and the last bin
/// for all that is farther.
inline constexpr int kDistanceBins = 24;

/// In Place::distance: the map has not seen this place, so a wall here would tell nothing.
inline constexpr std::uint8_t kUnseen = kDistanceBins;

/// The side of a wall from which it was seen is a direction, counted in parts of a turn.
inline constexpr int kDirections = 32;

/// In place of a direction: the wall is free on both sides, or its side is not known.
inline constexpr std::uint8_t kNoDirection = 255;

/// What a map says of walls at one place.
struct Place {
  std::uint8_t distance = kUnseen;     ///< to the nearest wall: a distance bin, or kUnseen
  std::uint8_t facing = kNoDirection;  ///< where that wall's free side is, as seen from the wall
};

/// A wall where a map has one.
struct WallPoint {
  Point2 position;                     ///< [cells, grid frame]
  std::uint8_t facing = kNoDirection;  ///< where its free side is
};

/// A map as the engine compares it: where its walls are and which way they face, and for every place how far
/// the nearest one is. The grid frame has its origin in the lower-left corner and is measured in cells.
struct WallMap {
  double cell = 1.0;             ///< side of a cell [m]
  int width = 0;                 ///< columns
  int height = 0;                ///< rows
  SE2 T_map_grid;                ///< grid frame to map frame, both in metres
  std::vector<Place> places;     ///< width * height
  std::vector<WallPoint> walls;  ///< one a cell that holds a wall
  std::array<double, kDistanceBins>
      background;  ///< share of the seen area in each distance bin; sums to 1, none is 0
};

/// Draws `grid` with cells of `cell` metres (at least the grid's own resolution). A wall point is the
/// centroid of the occupied cells inside its cell. Places known to the map or next to a known one count as
/// seen, so that a wall at the rim of what a robot saw may still be met. Distances: chamfer (3, 4) (Borgefors
/// 1986), within 8 % of the Euclidean. O(grid cells + cells).
WallMap make_wall_map(const OccupancyGrid& grid, double cell);

}  // namespace gridmerge
