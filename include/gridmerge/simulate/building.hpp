// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "gridmerge/export.hpp"
#include "gridmerge/grid/occupancy_grid.hpp"

namespace gridmerge {

/// What a building is like.
enum class BuildingKind {
  office,     ///< corridors between rows of rooms, many of one width
  hall,       ///< a large room with pillars, recesses and a few side rooms
  warehouse,  ///< long rows of racks that look alike
  apartment,  ///< few small rooms, much furniture
  symmetric,  ///< two wings that are one another turned by half a turn; only what stands in them differs
  loop,       ///< a corridor around a core, rooms outside
  curved,     ///< a corridor along an arc, radial and slanted walls
  outdoor,    ///< a fenced yard: houses at odd angles, trees, bushes, parked cars
  corridor,  ///< one long corridor along the longer side, perhaps bent or branched, with few doors and niches
  arena,  ///< blocks and pillars that lie on themselves after half or a quarter turn; up to 5 pillars do not
  maze,   ///< ways between walls that have no thickness, with some loops
  bare,   ///< a hall without furniture: walls, recesses, a few side rooms, perhaps pillars
};

/// All kinds, in the order above.
GRIDMERGE_EXPORT std::span<const BuildingKind> building_kinds();

/// As the command line and Python spell it.
GRIDMERGE_EXPORT const char* name_of(BuildingKind kind);

/// The kind of that name; none if there is none.
GRIDMERGE_EXPORT std::optional<BuildingKind> building_kind(std::string_view name);

/// A straight edge that stops a laser beam. Metres, in the building's frame.
struct Edge {
  Point2 a;           ///< one end
  Point2 b;           ///< the other end
  double echo = 1.0;  ///< probability that a beam which meets the edge ends there; glass lets most pass
};

inline constexpr double kGlass = 0.7;  ///< the echo of a window

/// What stands still: walls, windows, pillars, furniture.
struct Building {
  BuildingKind kind = BuildingKind::office;  ///< what it was drawn as
  double width = 0.0;                        ///< [m], along x; the lower left corner is near the origin
  double height = 0.0;                       ///< [m], along y
  std::vector<Edge> edges;                   ///< what stops a beam
};

inline constexpr double kMinBuildingSide = 8.0;    ///< [m]
inline constexpr double kMaxBuildingSide = 500.0;  ///< [m]

/// An invented building of about `width` x `height` metres. The same arguments give the same building.
/// Throws std::invalid_argument for sides outside [kMinBuildingSide, kMaxBuildingSide]. O(area); O(area^2)
/// for an arena, a quarter of a second at the largest.
GRIDMERGE_EXPORT Building make_building(BuildingKind kind, double width, double height, std::uint64_t seed);

/// The building as a map in its own frame, `resolution` metres a cell: edges occupied, floor that can be
/// reached free, the rest unknown. Throws std::invalid_argument unless resolution is in [0.01, 1]. O(cells).
GRIDMERGE_EXPORT OccupancyGrid draw_building(const Building& building, double resolution);

}  // namespace gridmerge
