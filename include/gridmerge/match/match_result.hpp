// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "gridmerge/grid/se2.hpp"
#include "gridmerge/match/pose_figures.hpp"
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

}  // namespace gridmerge
