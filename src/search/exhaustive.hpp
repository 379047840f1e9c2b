// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "similarity/likelihood_field.hpp"

namespace gridmerge::internal {

/// A pose that a search proposes.
struct PoseCandidate {
  SE2 T_fixed_moving;  ///< between the grid frames of two likelihood fields, in cells
  int score = 0;       ///< the search's own measure; larger is better
};

struct ExhaustiveSearchOptions {
  int coarse_factor = 5;      ///< cells of the likelihood fields to a cell of the search, along a side
  int rotations = 180;        ///< evenly spaced over the full turn
  std::size_t samples = 128;  ///< wall points of the moving map that are scored, at most kMaxSearchSamples
  std::size_t max_candidates = 1000;
  double sigma = 3.2;     ///< tolerance of the score [cells of the likelihood fields]
  double outliers = 0.5;  ///< see ErrorModel: generous, since only the ranking matters here
};

/// Keeps the 16-bit sums of the search from overflowing.
inline constexpr std::size_t kMaxSearchSamples = 240;

/// Scores the moving map's wall points at every rotation and every translation at which at least 8 % of them
/// can lie on the fixed map, and returns the best local maxima, best first. A score is the sum over the
/// sampled walls of the evidence (evidence_table) in the fixed map, averaged over the coarse cell in which
/// the wall falls, in whole sixths of a nat and at most 15 of them: the result is the same bits for any
/// number of threads, and on every machine whose C library gives the same bits for sin, cos, hypot, erf and
/// log. Shifts that by a bound cannot reach the score of the last candidate are passed over (branch and
/// bound, Lawler and Wood 1966, of one level), which changes nothing in the result. Runs in the calling TBB
/// arena. O(rotations * samples * translations).
std::vector<PoseCandidate> search_all_poses(const LikelihoodField& fixed, const LikelihoodField& moving,
                                            const ExhaustiveSearchOptions& options = {});

}  // namespace gridmerge::internal
