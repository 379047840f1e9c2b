// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "gridmerge/match/prepared_map.hpp"
#include "gridmerge/merge/arrangement.hpp"
#include "gridmerge/merge/known_pose.hpp"
#include "gridmerge/merge/merge_result.hpp"
#include "pose_graph.hpp"

namespace gridmerge {

/// A map whose pose is to be adjusted together with those of others.
struct AlignedMap {
  const PreparedMap* map;
  SE2 T_group_map;  ///< about where it lies, in a frame that all have in common
  MapExtent extent;
  std::optional<KnownPose> known_pose;
};

struct AdjustedPose {
  SE2 T_frame_map;
  PoseDeviation sd = {};  ///< 0 for a pose that is held
};

/// The poses that fit best to what is measured between them, to the maps' walls, and to what is known of the
/// poses beforehand: robust least squares (Ceres). The walls of every two maps between which something is
/// measured are drawn to each other (WallError). In the world's frame, with the fixed maps where they are
/// known to be, if there are any; otherwise in the frame of the first map. Standard deviations are of the
/// linearised problem without the walls, relative to what holds the frame.
std::vector<AdjustedPose> align(const std::vector<AlignedMap>& maps,
                                const std::vector<RelativePose>& measured);

}  // namespace gridmerge
