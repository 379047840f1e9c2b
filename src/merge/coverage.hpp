// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "gridmerge/grid/occupancy_grid.hpp"
#include "internal_export.hpp"
#include "merge/map_extent.hpp"

namespace gridmerge::internal {

/// What two maps both know.
struct InCommon {
  double share = 0.0;          ///< of the smaller map's known area
  std::vector<Point2> places;  ///< evenly drawn, at most 200 [m]
};

/// Where a map knows anything, coarsely: about 100 cells to its longer side.
class GRIDMERGE_INTERNAL_EXPORT Coverage {
 public:
  /// O(cells).
  explicit Coverage(const OccupancyGrid& grid);

  MapExtent extent() const;

  /// What both know when they lie so, to a few per cent of it; the places in the frame to which
  /// `T_frame_this` takes this map's. O(1).
  InCommon in_common(const Coverage& other, const SE2& T_this_other, const SE2& T_frame_this = {}) const;

 private:
  SE2 T_grid_map_;  // map frame to coarse cells' frame [m]
  double cell_ = 1.0;
  int width_ = 0, height_ = 0;
  std::vector<std::uint8_t> known_;
  std::vector<Point2> centres_;  // of known coarse cells, evenly drawn [m, map frame]
  double area_ = 0.0;            // [m^2]
  MapExtent extent_;
};

}  // namespace gridmerge::internal
