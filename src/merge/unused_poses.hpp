// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "gridmerge/merge/merge.hpp"
#include "internal_export.hpp"

namespace gridmerge::internal {

/// A known pose that a merge did not follow, and why.
struct UnusedPose {
  /// Why it was not followed.
  enum class Why {
    overruled,        ///< the map lies elsewhere: the maps say so
    not_sure_enough,  ///< the map was left out, and its pose alone joins it to none
    contradicted,     ///< the map was left out, though its pose is sure enough to join it
    against_match,    ///< the map was left out: it and another one alone surely lie elsewhere
  };

  std::size_t map = 0;       ///< index of the input map
  Why why = Why::overruled;  ///< why it was not followed
  /// Of an overruled pose, or one against the match, from where the map lies, or would lie [m, root mean
  /// square of its cells].
  double distance = 0.0;
  /// Of a pose that is not sure enough: the map whose known pose goes with it best. Of one against the match:
  /// the other map.
  std::size_t other = 0;
  double sd = 0.0;          ///< how far off the two put the maps (standard deviation [m])
  double sd_allowed = 0.0;  ///< how far off they may for known poses alone to join them [m]
  double angle = 0.0;       ///< what of `distance` is a turn [rad], 0 or more
};

/// Which of the poses that were known beforehand merge() did not follow, ascending by map. Of the members of
/// a component as many poses as can be true together are believed; which one is overruled of two that
/// contradict each other cannot be said, and it is the later one. A pose is believed within three standard
/// deviations, and the tolerance that bent maps need. Arguments as of merge(), with what it returned.
/// O(cells), and O(known^2) a component.
GRIDMERGE_INTERNAL_EXPORT std::vector<UnusedPose> find_unused_poses(
    const std::vector<OccupancyGrid>& maps, const std::vector<std::optional<KnownPose>>& known_poses,
    const MergeResult& result);

/// Two maps whose poses were fixed, and which alone would surely lie elsewhere.
struct ContradictedFix {
  std::size_t fixed = 0;   ///< index of an input map
  std::size_t moving = 0;  ///< index of a later one
  double distance = 0.0;   ///< of their fixed poses from how the two fit each other [m, see difference()]
  double angle = 0.0;      ///< what of it is a turn [rad], 0 or more
};

/// The fixed poses that merge() followed against what the maps say: of each pair that the maps' own match
/// accepts elsewhere, beyond the tolerance that bent maps need. In the order of the joins. Arguments as of
/// merge(), with what it returned. O(cells + joins).
GRIDMERGE_INTERNAL_EXPORT std::vector<ContradictedFix> find_contradicted_fixes(
    const std::vector<OccupancyGrid>& maps, const std::vector<std::optional<KnownPose>>& known_poses,
    const MergeResult& result);

}  // namespace gridmerge::internal
