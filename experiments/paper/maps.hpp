// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "gridmerge/similarity/image_similarity.hpp"
#include "gridmerge/simulate/simulate.hpp"

namespace gridmerge::paper {

/// The map of one robot: `side` x `side` cells about the middle of what it knows, as its range finder drew
/// it.
struct RobotMap {
  OccupancyGrid map;
  SE2 T_building_map;  ///< the truth
};

/// What the two robots that start back to back are to share: of the known cells of either map.
inline constexpr double kShareOfM3 = 0.0271, kShareOfM4 = 0.0854;

/// A draw of the experiment: a building, and the maps m1 to m8 of its eight robots.
///
/// m1 and m2 have most of the hall and two corridors in common. m3 and m4 start in the hall, back to back,
/// and wander off in opposite directions; they go as far as leaves them with the shares above. m5 to m8 go
/// round the building, and each has a part in common with the next.
struct Draw {
  std::uint64_t seed = 1;
  Building building;
  std::vector<RobotMap> robots;  ///< m1 is the first
};

/// Maps that cover 100 m in `side` cells per side (400 as the paper's). Throws std::runtime_error if the
/// shares of m3 and m4 cannot be had.
Draw make_draw(int side, std::uint64_t seed);

/// Two maps of a draw.
struct Pair {
  std::string name;
  const RobotMap* fixed;
  const RobotMap* moving;

  SE2 truth() const { return inverse(fixed->T_building_map) * moving->T_building_map; }
};

/// Maps by their numbers in the paper, from 1 on.
Pair pair_of(const Draw& draw, std::size_t fixed, std::size_t moving);

/// Cells that both maps of a pair know at the truth.
struct SharedCells {
  CommonClasses common;
  double of_fixed = 0.0;   ///< all three, as a share of the fixed map's known cells
  double of_moving = 0.0;  ///< ... of the moving map's
};
SharedCells measure_shared(const Pair& pair);

}  // namespace gridmerge::paper
