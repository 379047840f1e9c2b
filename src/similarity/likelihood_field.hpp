// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <vector>

#include "gridmerge/grid/occupancy_grid.hpp"

namespace gridmerge::internal {

/// Distances to the nearest wall are counted in whole cells: 0, 1, ... kDistanceBins - 2, and the last bin
/// for all that is farther.
inline constexpr int kDistanceBins = 24;

/// In Place::distance: the map has not seen this place, so a wall here would tell nothing.
inline constexpr std::uint8_t kUnseen = 255;

/// The side of a wall from which it was seen is a direction, counted in parts of a turn: a facing below
/// kDirections. A thin wall with floor on both sides has an axis instead, the direction across it:
/// kDirections plus parts of a turn, of half a turn. kNoDirection: neither is known.
inline constexpr int kDirections = 32;
inline constexpr int kAxes = kDirections / 2;
inline constexpr std::uint8_t kNoDirection = kDirections + kAxes;
inline constexpr int kFacingCodes = kNoDirection + 1;

/// Whether it is the axis of a wall with floor on both sides.
inline constexpr bool is_axis(std::uint8_t facing) {
  return facing >= kDirections && facing < kNoDirection;
}

/// The direction of a facing, or of an axis one of the two [rad, grid frame]. Not for kNoDirection.
inline double angle_of(std::uint8_t facing) {
  return 2.0 * std::numbers::pi * (is_axis(facing) ? facing - kDirections : facing) / kDirections;
}

/// The parts of a turn between two facings, either way; an axis has two directions. Not for kNoDirection.
inline constexpr int steps_between(std::uint8_t a, std::uint8_t b) {
  const int turn = is_axis(a) || is_axis(b) ? kAxes : kDirections;
  const int steps = (a % kDirections - b % kDirections + 2 * kDirections) % turn;
  return steps < turn - steps ? steps : turn - steps;
}

/// The facing after a turn by `steps` parts of a turn, which must not be negative.
inline constexpr std::uint8_t turned(std::uint8_t facing, int steps) {
  if (facing == kNoDirection) return facing;
  if (is_axis(facing)) return static_cast<std::uint8_t>(kDirections + (facing - kDirections + steps) % kAxes);
  return static_cast<std::uint8_t>((facing + steps) % kDirections);
}

/// The parts of a turn by which a map is turned, in [0, kDirections). `theta` [rad] may be several turns.
int steps_of_turn(double theta);

/// What a map says of walls at one place.
struct Place {
  std::uint8_t distance = kUnseen;     ///< to the nearest wall: a distance bin, or kUnseen
  std::uint8_t facing = kNoDirection;  ///< of that wall: where its free side is, or its axis
};

/// A wall where a map has one.
struct WallPoint {
  Point2 position;                     ///< [cells, grid frame]
  std::uint8_t facing = kNoDirection;  ///< where its free side is, or its axis
  bool stands_alone = false;  ///< it belongs to a small thing that touches no wall: furniture, a pillar
};

/// A map as the engine compares it: where its walls are and which way they face, and for every place how far
/// the nearest one is. The grid frame has its origin in the lower-left corner and is measured in cells.
struct LikelihoodField {
  double cell = 1.0;             ///< side of a cell [m]
  int width = 0;                 ///< columns
  int height = 0;                ///< rows
  SE2 T_map_grid;                ///< grid frame to map frame, both in metres
  std::vector<Place> places;     ///< width * height; those on the rim are always unseen
  std::vector<WallPoint> walls;  ///< one per cell that holds a wall
  std::array<double, kDistanceBins>
      background;  ///< share of the seen area in each distance bin; sums to 1, none is 0

  /// Where `places` holds a cell.
  std::size_t index(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(width) + static_cast<std::size_t>(column);
  }

  /// What the map says at a point of the grid frame [cells]; outside of it, nothing is seen.
  Place place_at(const Point2& point) const {
    if (!(point.x >= 0.0 && point.y >= 0.0 && point.x < width && point.y < height)) return {};
    return places[index(static_cast<int>(point.x), static_cast<int>(point.y))];
  }
};

/// Draws `grid` with cells of `cell` metres (at least the grid's own resolution). A wall point is the
/// centroid of the occupied cells inside its cell. Places known to the map or next to a known one count as
/// seen, so that a wall at the rim of what a robot saw may still be met. Distances: chamfer (3, 4) (Borgefors
/// 1986), within 8 % of the Euclidean. O(grid cells + cells).
LikelihoodField make_likelihood_field(const OccupancyGrid& grid, double cell);

}  // namespace gridmerge::internal
