// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gridmerge/grid/se2.hpp"

namespace gridmerge {

/// What is known beforehand of where a map lies. All known poses are in one frame, the world's.
struct KnownPose {
  SE2 T_world_map;           ///< takes the map's frame to the world's
  double sd_position = 0.0;  ///< standard deviation of the map's middle [m]
  double sd_theta = 0.0;     ///< standard deviation of theta [rad]
  bool fixed = false;        ///< it is the truth, whatever the maps say; the deviations play no part
};

/// Throws std::invalid_argument for a pose that is not finite or farther off than 10^7 m, or a deviation that
/// is less than 10^-6; those of a fixed pose may be 0.
void validate(const KnownPose& known);

}  // namespace gridmerge
