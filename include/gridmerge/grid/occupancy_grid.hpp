// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "gridmerge/export.hpp"
#include "gridmerge/grid/se2.hpp"

namespace gridmerge {

/// What a map says of a cell.
enum class Cell : std::uint8_t {
  unknown = 0,   ///< that it was not seen
  free = 1,      ///< that nothing stands there
  occupied = 2,  ///< that something stands there
};

/// An occupancy grid map: the layout of `nav_msgs/OccupancyGrid`.
///
/// Cells are row-major, row 0 at the bottom, y up: cell (column, row) is `cells[row * width + column]`.
/// `origin` is the pose of the lower-left corner of cell (0, 0) in the map frame; its yaw may be any angle.
struct OccupancyGrid {
  int width = 0;            ///< columns
  int height = 0;           ///< rows
  double resolution = 1.0;  ///< metres per cell side
  SE2 origin;  ///< T_map_grid: takes a point measured from the lower-left corner to the map frame
  std::vector<Cell> cells;  ///< width * height values
  /// Occupancy probabilities in [0, 1], NaN where unknown: width * height values, or empty where the input
  /// has none.
  std::vector<float> probability;

  /// Where `cells` and `probability` hold a cell, which has to be inside.
  std::size_t index(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(width) + static_cast<std::size_t>(column);
  }
  /// The value of a cell, which has to be inside.
  Cell at(int column, int row) const { return cells[index(column, row)]; }
  /// The same, to be changed.
  Cell& at(int column, int row) { return cells[index(column, row)]; }
  /// Whether there is such a cell.
  bool contains(int column, int row) const {
    return column >= 0 && column < width && row >= 0 && row < height;
  }

  /// Centre of a cell in the map frame [m].
  Point2 cell_centre(int column, int row) const {
    return origin * Point2{(column + 0.5) * resolution, (row + 0.5) * resolution};
  }
};

/// Merged, transformed and bent maps have no more cells than this, nor has a map that a RosNode hears. Files
/// and bags have this limit too, unless LoadOptions::max_cells says otherwise. Of 32 bits, so that it is
/// exact as a floating point number too.
inline constexpr std::uint32_t kMaxGridCells = std::uint32_t{1} << 28;

/// Resolutions below this are no map's [m/cell]: what has one is damaged or hostile.
inline constexpr double kMinResolution = 1e-6;
/// Nor are resolutions above this [m/cell].
inline constexpr double kMaxResolution = 1e3;

/// Whether a map may have this resolution [m/cell]: it lies within [kMinResolution, kMaxResolution].
constexpr bool is_resolution(double resolution) {
  return resolution >= kMinResolution && resolution <= kMaxResolution;
}

/// [m] Origins further from zero are in no file and no bag: far beyond any map, and still far from where a
/// double stops resolving micrometres. A grid's may lie twice as far: what is cut out of maps, or merged of
/// them, reaches beyond their origins.
inline constexpr double kMaxOrigin = 1e9;

/// A grid of `width` x `height` cells, all of them `fill`. Throws std::invalid_argument for a negative size.
GRIDMERGE_EXPORT OccupancyGrid make_grid(int width, int height, double resolution, const SE2& origin = {},
                                         Cell fill = Cell::unknown);

/// How many cells of each value a map has.
struct CellCounts {
  std::size_t unknown = 0;   ///< of Cell::unknown
  std::size_t free = 0;      ///< of Cell::free
  std::size_t occupied = 0;  ///< of Cell::occupied

  /// Of cells that are not unknown.
  std::size_t known() const { return free + occupied; }
};

/// Number of cells of each value. O(cells).
GRIDMERGE_EXPORT CellCounts count_cells(const OccupancyGrid& grid);

/// Throws std::invalid_argument, saying what is wrong, unless sizes are positive, the vectors' lengths fit
/// them, the resolution lies within [kMinResolution, kMaxResolution], the origin within 2 kMaxOrigin of zero
/// along each axis, its yaw is finite, and every cell has a value that Cell names. O(cells).
GRIDMERGE_EXPORT void validate(const OccupancyGrid& grid);

/// A map, and the transform that takes its frame to the output's.
struct PlacedMap {
  const OccupancyGrid* map = nullptr;  ///< not owned; outlives its use
  SE2 T_output_map;                    ///< takes the map's frame to the output's [m, rad]
};

/// Throws std::invalid_argument unless there is a map, a valid one, and the transform is finite.
GRIDMERGE_EXPORT void validate(const PlacedMap& placed);

}  // namespace gridmerge
