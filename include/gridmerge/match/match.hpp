// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "gridmerge/grid/occupancy_grid.hpp"
#include "gridmerge/match/pose_figures.hpp"
#include "gridmerge/match/prepared_map.hpp"
#include "gridmerge/match/search_method.hpp"
#include "gridmerge/match/verdict.hpp"

namespace gridmerge {

/// One way in which the moving map may lie on the fixed one.
struct Hypothesis {
  SE2 T_fixed_moving;  ///< between the map frames
  /// Larger is better: the log-likelihood ratio "same place" against "unrelated" [nats].
  double score = 0.0;
  double probability = 0.0;  ///< that this pose is the true one
  PoseFigures figures = {};  ///< what speaks for it
};

struct MatchOptions {
  SearchMethod search = SearchMethod::exhaustive;  ///< how poses are found
  int threads = 0;                   ///< worker threads; 0 = one a core. The result does not depend on it.
  std::size_t max_hypotheses = 10;   ///< how many distinct hypotheses the result lists; some 30 are judged
  double accept_probability = 0.95;  ///< the verdict is `accepted` from this probability on
  /// Called now and then with the share of the work that is done, in [0, 1]; never from two threads at once.
  std::function<void(double)> progress;
};

struct MatchResult {
  Verdict verdict = Verdict::refused;
  Reason reason = Reason::nothing_to_compare;  ///< why it was refused
  SE2 T_fixed_moving;                          ///< the best hypothesis, given for a refused pair too
  double probability = 0.0;                    ///< that the best hypothesis is the true pose
  double acceptance_index = 0.0;  ///< agreement / (agreement + disagreement); 0 when nothing overlaps
  std::int64_t agreement = 0;     ///< cells known in both maps and equal
  std::int64_t disagreement = 0;  ///< cells known in both maps and different
  double overlap = 0.0;           ///< share of the smaller map's known cells that are known in both
  double seconds = 0.0;           ///< wall time from grids in memory to the verdict
  /// Distinct, most probable first; empty only when a map has nothing to go by.
  std::vector<Hypothesis> hypotheses;
};

/// The result of the same two maps when the other one is called fixed. O(hypotheses).
MatchResult inverse(MatchResult result);

/// Finds how `moving` lies on `fixed`, searching every pose, and says whether to believe it.
/// Throws std::invalid_argument for an invalid grid or option (see validate()).
MatchResult match(const OccupancyGrid& fixed, const OccupancyGrid& moving, const MatchOptions& options = {});

/// The same of maps that are matched with several others. Runs in the calling TBB arena, for which
/// `options.threads` changes nothing; may be called by several threads at once.
MatchResult match(const PreparedMap& fixed, const PreparedMap& moving, const MatchOptions& options = {});

/// The side of the cells in which two maps are compared [m]: the coarser map's, or a multiple of it for large
/// maps.
double working_cell(const PreparedMap& fixed, const PreparedMap& moving);

/// Throws std::invalid_argument for options that make no sense.
void validate(const MatchOptions& options);

}  // namespace gridmerge
