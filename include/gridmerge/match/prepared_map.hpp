// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "gridmerge/export.hpp"
#include "gridmerge/grid/occupancy_grid.hpp"

namespace gridmerge {

namespace internal {
class DrawnWalls;
}

/// A map with all that matches of it have in common, so that it is worked out once and not for every other
/// map that it is matched with. May be used by several threads at once.
class GRIDMERGE_EXPORT PreparedMap {
 public:
  /// Copies what robots have seen of `grid`: without painted cells (see without_painted()), so nothing of a
  /// drawing in which no cell is free. Throws std::invalid_argument for an invalid grid (see validate()).
  /// O(cells).
  explicit PreparedMap(const OccupancyGrid& grid);
  ~PreparedMap();

  const OccupancyGrid& known() const { return known_; }  ///< cropped, and turned by quarters
  const CellCounts& counts() const { return counts_; }   ///< of known()

 private:
  friend class internal::DrawnWalls;
  /// `known` as a prepared map has it.
  PreparedMap(OccupancyGrid known, const CellCounts& counts);

  OccupancyGrid known_;
  CellCounts counts_;
  std::unique_ptr<internal::DrawnWalls> drawn_;
};

/// Orders maps by what they hold, not by where they come from: by their known area, and what differs between
/// maps of the same area. Of two maps the smaller is searched in the larger one.
GRIDMERGE_EXPORT bool is_smaller(const PreparedMap& a, const PreparedMap& b);

}  // namespace gridmerge
