// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "gridmerge/match/match.hpp"
#include "gridmerge/merge/merge.hpp"
#include "gridmerge/merge/merge_result.hpp"
#include "merge/map_extent.hpp"
#include "merge/pose_graph.hpp"

namespace gridmerge::internal {

/// A map whose pose is to be adjusted together with those of others.
struct AlignedMap {
  const PreparedMap* map;
  SE2 T_group_map;  ///< about where it lies, in a frame that all have in common
  MapExtent extent;
  std::optional<KnownPose> known_pose;

  bool is_fixed() const { return known_pose && known_pose->fixed; }
};

/// The poses that fit best to what is measured between them, to the maps' walls, and to what is known of the
/// poses beforehand: robust least squares (Ceres). The walls of maps between which something is measured are
/// drawn to each other (WallError), of every map those of the few that it is measured to best. In the world's
/// frame, with the fixed maps where they are known to be, if there are any; otherwise in the frame of the
/// first map.
std::vector<SE2> align(const std::vector<AlignedMap>& maps, const std::vector<RelativePose>& measured);

/// How well the poses are known: standard deviations of the linearised problem, relative to the fixed maps
/// or, if there are none, to the map at `held`; 0 for those, none where the problem does not determine them.
/// Without the walls: each of them is precise, but where maps are bent all are off together.
std::vector<std::optional<PoseDeviation>> find_deviations(const std::vector<AlignedMap>& maps,
                                                          const std::vector<RelativePose>& measured,
                                                          std::size_t held);

}  // namespace gridmerge::internal
