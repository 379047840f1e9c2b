// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gridmerge/merge/merge.hpp"
#include "merge/pair_candidates.hpp"

namespace gridmerge::internal {

/// A true pose lies within so many standard deviations of what is known.
inline constexpr double kDeviationsOfKnown = 3.0;

/// The standard deviation with which two known poses tell how their maps lie to each other, as a displacement
/// of the maps' cells [m].
double sd_between(const KnownPose& fixed, const KnownPose& moving, const MapExtent& fixed_extent,
                  const MapExtent& moving_extent);

/// What two known poses, not both fixed, say of how their maps lie to each other: candidates near it become
/// likelier, others less likely, by more the better the poses are known; and if they are known as well as a
/// match tells a pose, what is known is a candidate too, of its own if none of the maps' lies there. It is
/// worth less where the maps have much in common and propose nothing near.
void apply_known_poses(const KnownPose& fixed, const KnownPose& moving, const ProblemMap& fixed_map,
                       const ProblemMap& moving_map, PairCandidates& pair);

}  // namespace gridmerge::internal
