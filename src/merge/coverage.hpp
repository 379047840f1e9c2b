// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "gridmerge/grid/occupancy_grid.hpp"
#include "internal_export.hpp"
#include "merge/map_extent.hpp"

namespace gridmerge::internal {

/// Where a map knows anything, coarsely: about 100 cells to its longer side.
class GRIDMERGE_INTERNAL_EXPORT Coverage {
 public:
  /// O(cells).
  explicit Coverage(const OccupancyGrid& grid);

  MapExtent extent() const;

  /// How much of the smaller map's known area both know when they lie so, to a few per cent of it. O(1).
  double share_in_common(const Coverage& other, const ManyPointsTransform& T_this_other) const;

  /// Places that both know then, evenly drawn, at most 200 [m, the frame to which `T_frame_this` takes this
  /// map's points]. O(1).
  std::vector<Point2> places_in_common(const Coverage& other, const ManyPointsTransform& T_this_other,
                                       const ManyPointsTransform& T_frame_this) const;

 private:
  /// Calls back with each drawn place of the smaller map that the larger one knows too: in the smaller one's
  /// frame, and whether that is the other map.
  template <typename Visit>
  void visit_common(const Coverage& other, const ManyPointsTransform& T_this_other, Visit visit) const;

  ManyPointsTransform T_grid_map_;  // map frame to coarse cells' frame [m]
  double cell_ = 1.0;
  int width_ = 0, height_ = 0;
  std::vector<std::uint8_t> known_;
  std::vector<Point2> centres_;  // of known coarse cells, evenly drawn [m, map frame]
  double reach_ = 0.0;           // no known coarse cell has a point farther from the extent's centre [m]
  double area_ = 0.0;            // [m^2]
  MapExtent extent_;
};

}  // namespace gridmerge::internal
