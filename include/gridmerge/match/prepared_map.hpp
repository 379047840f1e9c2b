// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <memory>
#include <mutex>

#include "gridmerge/export.hpp"
#include "gridmerge/grid/occupancy_grid.hpp"

namespace gridmerge {

namespace internal {
struct WallMap;
}

/// A map with all that matches of it have in common, so that it is worked out once and not for every other
/// map that it is matched with. May be used by several threads at once.
class GRIDMERGE_EXPORT PreparedMap {
 public:
  /// Copies what is known of `grid`. Throws std::invalid_argument for an invalid grid (see validate()).
  explicit PreparedMap(const OccupancyGrid& grid);
  ~PreparedMap();

  const OccupancyGrid& known() const { return known_; }  ///< cropped to its known cells
  const CellCounts& counts() const { return counts_; }   ///< of known()

  /// For the engine: the map as it compares it, in cells of `cell` metres; drawn when first asked for.
  /// O(cells) then.
  const internal::WallMap& walls(double cell) const;

 private:
  OccupancyGrid known_;
  CellCounts counts_;
  mutable std::mutex drawing_;
  mutable std::map<double, std::unique_ptr<const internal::WallMap>> walls_;  // by cell
};

/// Orders maps by what they hold, not by where they come from: by their known area, and what differs between
/// maps of the same area. Of two maps the smaller is searched in the larger one.
GRIDMERGE_EXPORT bool is_smaller(const PreparedMap& a, const PreparedMap& b);

}  // namespace gridmerge
