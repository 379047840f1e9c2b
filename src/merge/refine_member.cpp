// SPDX-License-Identifier: Apache-2.0
#include "merge/refine_member.hpp"

#include <stdexcept>
#include <string>

#include "gridmerge/merge/fuse.hpp"
#include "merge/joins.hpp"

namespace gridmerge::internal {

namespace {

constexpr double kMaxCells = 67108864.0;  // 2^26

OccupancyGrid fuse_in_bounds(const std::vector<PlacedMap>& maps) {
  const double resolution = finest_resolution(maps);
  try {
    const Lattice lattice = cover(maps, resolution);
    if (static_cast<double>(lattice.width) * lattice.height > kMaxCells)
      throw std::invalid_argument("the merged map would exceed 2^26 cells");
    return fuse(maps, resolution).grid;
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(std::string("the fixed maps: ") + error.what());
  }
}

}  // namespace

RefinedPose refine_member(const std::vector<PlacedMap>& fixed, const PlacedMap& moving) {
  if (fixed.empty()) throw std::invalid_argument("there is no fixed map");
  validate(moving);
  validate(fixed.front());
  const PreparedMap prepared(*moving.map);
  if (fixed.size() > 1) return refine_pose(PreparedMap(fuse_in_bounds(fixed)), prepared, moving.T_output_map);
  const SE2& T_output_fixed = fixed.front().T_output_map;
  RefinedPose refined =
      refine_pose(PreparedMap(*fixed.front().map), prepared, inverse(T_output_fixed) * moving.T_output_map);
  refined.T_fixed_moving = T_output_fixed * refined.T_fixed_moving;
  return refined;
}

}  // namespace gridmerge::internal
