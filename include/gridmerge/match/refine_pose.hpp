// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gridmerge/export.hpp"
#include "gridmerge/grid/se2.hpp"
#include "gridmerge/match/match.hpp"
#include "gridmerge/match/prepared_map.hpp"

namespace gridmerge {

/// A pose that somebody proposed, put right.
struct RefinedPose : PairPose {
  double score = 0.0;        ///< log-likelihood ratio "same place" against "unrelated" [nats]
  double start_score = 0.0;  ///< the same of the pose that was proposed
  double moved = 0.0;        ///< root mean square displacement of the moving map's walls from there [m]
};

/// Climbs from `T_start` to the local maximum of the evidence near it: the best one that is reached from
/// poses within about a metre and seven degrees of it, by the evidence by which match() ranks its hypotheses.
/// Where none is better than the start, that is the answer. With cells of less than 2 cm it looks less far
/// than a metre: 50 to 100 cells, the more the larger the maps.
///
/// The probability is what match() would give to the pose were it one of its hypotheses: the same model of
/// the same figures, against all distinct hypotheses of a full search. Where another pose explains the maps
/// better the probability is below a half; where the pose explains nothing it is 0. That somebody proposed
/// the pose counts for nothing in it.
///
/// Throws std::invalid_argument for a start that is not finite. Neither pose nor figures depend on which map
/// is called fixed, but for rounding, nor on the number of threads. Runs in the calling TBB arena; about
/// twice the time of match().
GRIDMERGE_EXPORT RefinedPose refine_pose(const PreparedMap& fixed, const PreparedMap& moving,
                                         const SE2& T_start);

/// What the engine says of a pose as it stands: its score, its figures, and the probability that
/// refine_pose() would give it. Argument, errors, threads and time as there.
GRIDMERGE_EXPORT Hypothesis judge_pose(const PreparedMap& fixed, const PreparedMap& moving,
                                       const SE2& T_fixed_moving);

}  // namespace gridmerge
