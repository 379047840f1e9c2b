// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gridmerge/merge/arrangement.hpp"
#include "gridmerge/merge/known_pose.hpp"

namespace gridmerge {

/// Throws std::invalid_argument for a pose that is not finite or a deviation that is not positive; those of a
/// fixed pose may be 0.
void validate_known_pose(const KnownPose& known);

/// The standard deviation of a known pose as a displacement of the map's cells [m].
double sd_of(const KnownPose& known, const MapExtent& extent);

/// What two known poses say of how their maps lie to each other: candidates near it become likelier, others
/// less likely; if there is none near it, what is known is a candidate itself. Of two fixed poses it is the
/// only one.
void apply_known_poses(const KnownPose& fixed, const KnownPose& moving, const MapExtent& fixed_extent,
                       const MapExtent& moving_extent, PairCandidates& pair);

}  // namespace gridmerge
