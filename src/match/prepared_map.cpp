// SPDX-License-Identifier: Apache-2.0
#include "gridmerge/match/prepared_map.hpp"

#include <tuple>

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

bool is_smaller(const PreparedMap& a, const PreparedMap& b) {
  const auto key = [](const PreparedMap& map) {
    const OccupancyGrid& grid = map.known();
    return std::tuple(static_cast<double>(map.counts().known()) * grid.resolution * grid.resolution,
                      map.counts().occupied, grid.width, grid.height);
  };
  const auto key_a = key(a);
  const auto key_b = key(b);
  return key_a != key_b ? key_a < key_b : a.known().cells < b.known().cells;
}

}  // namespace gridmerge
