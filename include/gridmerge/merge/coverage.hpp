// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "gridmerge/grid/occupancy_grid.hpp"

namespace gridmerge {

/// Where a map's known cells are: what it takes to say how far apart two poses put them.
struct MapExtent {
  Point2 centre;        ///< of the known cells [m, map frame]
  double radius = 0.0;  ///< root mean square distance of the known cells from the centre [m]
  double side = 0.0;    ///< of the known cells, the longer one [m]
};

/// Where a map knows anything, coarsely: about 100 cells to its longer side.
class Coverage {
 public:
  /// O(cells).
  explicit Coverage(const OccupancyGrid& grid);

  MapExtent extent() const;

  /// The share of the smaller map's known area that both know when they lie so, to a few per cent. O(1).
  double share_in_common(const Coverage& other, const SE2& T_this_other) const;

  /// Places that both know when they lie so, evenly drawn of the smaller map's [m, this map's frame]; at most
  /// 500. O(1).
  std::vector<Point2> in_common(const Coverage& other, const SE2& T_this_other) const;

 private:
  bool knows(const Point2& at) const;

  SE2 T_grid_map_;  // map frame to coarse cells' frame [m]
  double cell_ = 1.0;
  int width_ = 0, height_ = 0;
  std::vector<std::uint8_t> known_;
  std::vector<Point2> centres_;  // of known coarse cells, evenly drawn [m, map frame]
  double area_ = 0.0;            // [m^2]
  MapExtent extent_;
};

}  // namespace gridmerge
