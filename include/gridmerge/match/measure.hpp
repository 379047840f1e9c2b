// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "gridmerge/export.hpp"
#include "gridmerge/grid/occupancy_grid.hpp"
#include "gridmerge/grid/se2.hpp"
#include "gridmerge/match/match.hpp"
#include "gridmerge/match/match_result.hpp"
#include "gridmerge/similarity/image_similarity.hpp"

namespace gridmerge {

/// What is to be said of one pose of two maps, found or not: by the measures of Birk & Carpin (2006), whose
/// Delta follows from `similarity` for any c_lock, and by the engine.
struct PoseMeasure {
  SE2 T_fixed_moving;          ///< between the map frames [m, rad]
  std::int64_t cells = 0;      ///< of the fixed map: those that omega counts among
  ImageSimilarity similarity;  ///< omega, psi, agr, dis
  CommonClasses common;        ///< agr and dis by class
  Hypothesis engine;           ///< what match() would say of the pose, were it one of its hypotheses
};

/// The same of several maps laid on one.
struct JointMeasure {
  std::int64_t omega = 0;          ///< cells of the fixed map at which all maps have the same value (eq. 3)
  std::int64_t cells = 0;          ///< of the fixed map
  std::vector<PoseMeasure> pairs;  ///< each moving map on the fixed one, in their order
};

/// Measures moving maps laid on a fixed one: their `T_output_map` is T_fixed_moving [m, rad]. `threads` as in
/// MatchOptions; the result does not depend on it. Throws std::invalid_argument for no moving map, for one
/// that validate() refuses, as SimilarityMeter does, and for a map that lies on none of the others
/// (lie_on_each_other()), naming it by its place. Per moving map the time of match() and of a Delta.
GRIDMERGE_EXPORT JointMeasure measure_maps(const OccupancyGrid& fixed, std::span<const PlacedMap> moving,
                                           int threads = 0);

/// The same of a single moving map.
GRIDMERGE_EXPORT PoseMeasure measure_pose(const OccupancyGrid& fixed, const OccupancyGrid& moving,
                                          const SE2& T_fixed_moving, int threads = 0);

}  // namespace gridmerge
