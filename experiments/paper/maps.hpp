// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "building.hpp"

namespace gridmerge::paper {

/// Six robots' maps of the building, `side` x `side` cells that cover 100 m: 1 and 2 have much in common, 3
/// and 4 little.
std::vector<RobotMap> make_maps(int side);

/// How two maps are compared.
struct Pair {
  std::string name;
  const RobotMap* fixed;
  const RobotMap* moving;

  SE2 truth() const { return inverse(fixed->T_building_map) * moving->T_building_map; }
};

/// Known cells that both maps of a pair know, as a share of each one's.
struct SharedCells {
  double of_fixed;
  double of_moving;
};
SharedCells measure_shared(const Pair& pair);

/// A picture as in the paper: free green, occupied red, unknown white. The bytes of a PNG.
std::string draw(const OccupancyGrid& map);

/// The same of the two maps of a pair, the moving one placed at `T_fixed_moving`.
std::string draw_merged(const Pair& pair, const SE2& T_fixed_moving);

}  // namespace gridmerge::paper
