// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "gridmerge/match/match.hpp"
#include "gridmerge/match/prepared_map.hpp"
#include "gridmerge/match/refine.hpp"
#include "gridmerge/match/verdict.hpp"
#include "gridmerge/search/exhaustive.hpp"
#include "gridmerge/similarity/agreement.hpp"

namespace gridmerge {

/// Distinct poses that are ranked. More than most callers ask for: the true one may come up from behind.
inline constexpr std::size_t kRankedPoses = 12;

/// Two maps in the cells in which they are compared. Not owned.
struct ComparedMaps {
  /// `moving` is the smaller one by is_smaller(): its walls have the best chance to be met in the other one.
  ComparedMaps(const PreparedMap& fixed, const PreparedMap& moving);

  const OccupancyGrid& fixed;
  const OccupancyGrid& moving;
  double cell;  ///< side [m]
  const WallMap& fixed_walls;
  const WallMap& moving_walls;
};

/// A pose between map frames, from one between grid frames in cells, and the inverse.
SE2 to_map_frames(const SE2& T_cells, const WallMap& fixed, const WallMap& moving);
SE2 to_cells(const SE2& T_fixed_moving, const WallMap& fixed, const WallMap& moving);

/// How densely every pose of these maps is searched.
ExhaustiveSearchOptions choose_search(const ComparedMaps& maps);

/// Poses displaced by less than this are one hypothesis [cells].
double distinct_displacement(const ComparedMaps& maps);

struct RankedPose {
  Hypothesis hypothesis;  ///< its probability is not yet known
  Evidence walls;
};

/// The evidence of the walls and of the area that both maps know.
RankedPose rank(const ScoredPose& pose, const ComparedMaps& maps);

/// Searches all poses, refines and ranks them: distinct ones, best first, without those that on the whole
/// speak against themselves. `progress` as in MatchOptions. Runs in the calling TBB arena.
std::vector<RankedPose> find_hypotheses(const ComparedMaps& maps, std::size_t max_hypotheses,
                                        const std::function<void(double)>& progress);

/// What speaks for a hypothesis. `lead` as find_lead(); `common` as count_agreement() of all cells.
VerdictFeatures measure_features(const RankedPose& pose, double lead, const AgreementCounts& common,
                                 const ComparedMaps& maps);

}  // namespace gridmerge
