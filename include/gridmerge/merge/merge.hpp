// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

#include "gridmerge/export.hpp"
#include "gridmerge/grid/deformation.hpp"
#include "gridmerge/grid/occupancy_grid.hpp"
#include "gridmerge/grid/se2.hpp"
#include "gridmerge/match/match.hpp"
#include "gridmerge/merge/merge_result.hpp"

namespace gridmerge {

/// How maps are merged.
struct MergeOptions {
  /// How each pair is matched, and from which probability on maps are joined; its progress callback is
  /// not used. Neither `scales` nor the random walk is allowed.
  MatchOptions match;
  /// So many joins of the whole merge may be expected to be false, beside what `match.accept_probability`
  /// asks of each: the least sure ones are not made. Of more than 50 maps, so many for every 50. As many
  /// parts on a plan may be expected to be false besides; see place_on_plan().
  double max_false_joins = 0.05;
  /// Of more than 50 maps only likely pairs are matched: those left out hide, as far as is known, at most
  /// this share of all joins. Up to 0.2, and of fewer maps, all pairs are matched. In [0, 1).
  double max_missed = 0.0;
  /// Of the merged maps [m/cell], as is_resolution() allows; 0 = the finest among a map's inputs, or so much
  /// coarser, by a power of two up to 16, that the merged map has at most kMaxGridCells.
  double resolution = 0.0;
  /// What is done to maps so that walls that are one come to lie on each other: `similarity` and `affine` are
  /// for maps of a false scale or sheared axes, `elastic` is for maps that drift has bent. It changes neither
  /// which maps join nor how sure that is. See Member::deformation.
  MapTransform transform = MapTransform::rigid;
  /// Called with the numbers of pairs that are matched and to be matched, never from two threads at once. The
  /// numbers begin anew with each round: with the second look, and of many maps with each choice of pairs.
  /// Matches of maps with merged groups are not reported.
  std::function<void(std::size_t, std::size_t)> progress;
};

/// Throws std::invalid_argument, saying what is wrong, for options that make no sense.
GRIDMERGE_EXPORT void validate(const MergeOptions& options);

/// What is known beforehand of where a map lies. All known poses are in one frame, the world's. One that is
/// not fixed has to be given its deviations.
struct KnownPose {
  SE2 T_world_map;           ///< takes the map's frame to the world's
  double sd_position = 0.0;  ///< standard deviation of the map's middle [m]
  double sd_theta = 0.0;     ///< standard deviation of theta [rad]
  bool fixed = false;        ///< it is the truth, whatever the maps say; the deviations play no part
};

/// Throws std::invalid_argument for a pose that is not finite or farther off than 10^7 m, or a deviation that
/// is less than 10^-6 or more than 10^5; those of a fixed pose may be any.
GRIDMERGE_EXPORT void validate(const KnownPose& known);

/// Merges `maps` by what all pairs of them say together.
///
/// Every pair is matched, or of many maps the likely ones (see MergeOptions::max_missed), and all hypotheses
/// are kept. The consistent set of all maps that they speak for most is chosen: a weak pair that agrees with
/// the others is used, a strong one that contradicts them is not. Then all poses are adjusted together, to
/// what the pairs and the maps' walls say (robust least squares), and the maps of each component are fused in
/// one pass. Maps that nothing joins surely enough are left out; groups between which nothing is sure are
/// components of their own.
///
/// `known_poses[i]`, where there is one, is what is known of map i beforehand; it may be shorter than `maps`.
/// Known poses of two maps that are not fixed speak for joining them so: the maps' own hypothesis there
/// becomes a strong one, or what is known one more hypothesis. The poses of fixed maps are not changed, and
/// the component that holds one has the world's frame. With no fixed map in it a component has the frame of
/// its first member.
///
/// The result does not depend on the number of threads, nor on the order of the maps, with two exceptions:
/// without fixed maps the frame of a component is its first member's, and `joins` are in the order (0, 1),
/// (0, 2), ... Throws
/// std::invalid_argument for an invalid grid, option or known pose, naming the map by its index, for more
/// known poses than maps, and when a merged map would exceed kMaxGridCells cells. At most k * (k - 1) / 2
/// matches for k maps.
GRIDMERGE_EXPORT MergeResult merge(const std::vector<OccupancyGrid>& maps, const MergeOptions& options = {},
                                   const std::vector<std::optional<KnownPose>>& known_poses = {});

}  // namespace gridmerge
