// SPDX-License-Identifier: Apache-2.0
#include "gridmerge/match/prepared_map.hpp"

#include "gridmerge/grid/resample.hpp"

namespace gridmerge {

PreparedMap::PreparedMap(const OccupancyGrid& grid) {
  validate(grid);
  known_ = crop_to_known(grid);
  counts_ = count_cells(known_);
}

const WallMap& PreparedMap::walls(double cell) const {
  const std::lock_guard lock(drawing_);
  std::unique_ptr<const WallMap>& drawn = walls_[cell];
  if (!drawn) drawn = std::make_unique<const WallMap>(make_wall_map(known_, cell));
  return *drawn;
}

}  // namespace gridmerge
