// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "grid/box.hpp"
#include "grid/cell_box.hpp"
#include "gridmerge/grid/occupancy_grid.hpp"

namespace gridmerge::internal {

/// A map that is drawn beam by beam: log-odds of each cell, clamped (Moravec & Elfes 1985). The frame's
/// origin lies on a corner of cells.
class Mapper {
 public:
  /// For beams that stay in a box [m, map frame]. Throws std::invalid_argument for a box of more than
  /// kMaxGridCells. O(cells).
  Mapper(double resolution, const Box& reach);

  /// A beam from one point to another, in metres of the map's frame: free up to the end, where there is a
  /// wall if it `hits`. Parts outside the map are left out. O(cells crossed).
  void add_beam(Point2 from, Point2 to, bool hits);

  /// The map so far, cropped to what is known: occupied above a probability of 0.65, free below 0.196.
  OccupancyGrid grid() const;

 private:
  void update(int column, int row, float evidence);

  double resolution_;
  CellBox raster_;               // cells from the frame's origin
  std::vector<float> log_odds_;  // NaN: no beam came there
};

}  // namespace gridmerge::internal
