// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "gridmerge/grid/se2.hpp"
#include "similarity/likelihood_field.hpp"

namespace gridmerge::internal {

/// Where the long walls of a map lie: for each of four sides at right angles, how much wall faces it at which
/// distance along it. Most buildings have walls in two directions only; of others this says nothing.
struct WallProfiles {
  /// One of the four sides, in the grid frame; the others follow by quarters, counter-clockwise [rad].
  double theta = 0.0;
  double first = 0.0;  ///< where the profiles begin, along their side [m]
  /// By side, one value each kProfileStep: more than usual is positive, less is negative. Empty where walls
  /// face all ways.
  std::array<std::vector<std::int16_t>, 4> sides;
};

inline constexpr double kProfileStep = 0.3;  // [m]

WallProfiles make_profiles(const LikelihoodField& field);

/// A pose between grid frames that profiles propose, and how well they go together there.
struct ProfilePose {
  SE2 T_fixed_moving;  ///< [m, rad]
  double likeness = 0.0;
};

/// The poses under which most long walls lie on each other, most alike first; at most `most`.
/// O(length of the profiles^2).
std::vector<ProfilePose> align_profiles(const WallProfiles& fixed, const WallProfiles& moving,
                                        std::size_t most);

}  // namespace gridmerge::internal
