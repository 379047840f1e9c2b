// SPDX-License-Identifier: Apache-2.0
// What is kept of a map to find out, in microseconds, whether it may share a place with another one.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "gridmerge/grid/occupancy_grid.hpp"
#include "internal_export.hpp"
#include "preselect/profiles.hpp"
#include "similarity/likelihood_field.hpp"

namespace gridmerge::internal {

/// A corner of walls, or another place where they do not all face the same way.
struct Keypoint {
  Point2 position;     ///< [m, grid frame]
  double theta = 0.0;  ///< direction of its walls, known up to quarters of a turn [rad, in [0, pi/2)]
};

/// So many places about a keypoint make its descriptor: on six rings, each with a multiple of four places.
inline constexpr std::size_t kDescriptorSize = 96;

/// How near the nearest wall is at places about a keypoint, turned with it: positive at walls, negative in
/// the open, 0 where nothing was seen. Of length 4096 or less: it is shorter where little was seen.
using Descriptor = std::array<std::int16_t, kDescriptorSize>;

/// The same about the keypoint turned by `quarters` quarters, counter-clockwise: a permutation.
Descriptor quarter_turned(const Descriptor& descriptor, int quarters);

/// Walls that face another way than the one they meet by more parts of a turn than this show something else.
inline constexpr int kMostTurned = 4;

/// A wall of the map, thinned out.
struct SampledWall {
  Point2 position;                     ///< [m, grid frame]
  std::uint8_t facing = kNoDirection;  ///< as LikelihoodField has it
};

/// What maps are preselected by. All lengths are in metres, so resolutions may differ.
struct Signature {
  double cell = 1.0;         ///< side of the cells of `places` [m]
  int width = 0;             ///< columns
  int height = 0;            ///< rows
  SE2 T_map_grid;            ///< grid frame to map frame, both in metres
  double known_area = 0.0;   ///< [m^2]
  double wall_length = 0.0;  ///< of all walls, a cell's side each [m]
  std::vector<Place> places;
  std::vector<SampledWall> walls;
  int met_within = 0;              ///< a wall at most so far from one of this map meets it [distance bin]
  int open_from = 0;               ///< and one so far from all lies in the open [distance bin]
  double chance_of_meeting = 0.0;  ///< of a wall that lies anywhere and faces any side
  WallProfiles profiles;
  std::vector<Keypoint> keypoints;
  std::vector<Descriptor> descriptors;  ///< one a keypoint

  /// What the map says at a point of its grid frame [m]; outside of it, nothing is seen.
  Place place_at(const Point2& at) const {
    const double x = at.x / cell, y = at.y / cell;
    if (!(x >= 0.0 && y >= 0.0 && x < width && y < height)) return {};
    return places[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                  static_cast<std::size_t>(x)];
  }
};

/// Works it out. Cells are 0.2 m, the map's own if these are larger, or larger ones for a map of more than a
/// million. O(cells of the grid + cells + walls * walls nearby).
GRIDMERGE_INTERNAL_EXPORT Signature make_signature(const OccupancyGrid& grid);

}  // namespace gridmerge::internal
