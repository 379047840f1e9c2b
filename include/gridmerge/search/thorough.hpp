// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "gridmerge/search/exhaustive.hpp"

namespace gridmerge {

struct ThoroughSearchOptions {
  int coarse_factor = 5;      ///< cells of the wall maps to a cell of the search, along a side
  int rotations = 180;        ///< evenly spaced over the full turn
  std::size_t samples = 512;  ///< wall points of the moving map that are scored, at most kMostThoroughSamples
  std::size_t max_candidates = 600;
  double sigma = 4.0;     ///< tolerance of the score [cells of the wall maps]
  double outliers = 0.5;  ///< see ErrorModel: generous, since only the ranking matters here
};

/// Keeps the 16-bit sums of the search from overflowing.
inline constexpr std::size_t kMostThoroughSamples = 2000;

/// Samples that lie where the fixed map has seen, from which on a pose is looked at.
inline constexpr double kLeastSeenSamples = 25.0;

/// As search_all_poses(), for maps that share little. Two things differ.
/// - Facings count: the evidence of a wall depends on which way its free side looks (evidence_table()), in
///   sectors of 22.5 degrees.
/// - A score is what a pose scores beyond what unrelated ones do that see as much, in their standard
///   deviations (unnormalised, what overlaps little is lost among what overlaps much by chance):
///     (S + 0.37 n) / (0.48 n^0.75),
///   S the sum of the evidence [nats], n the samples that fall where the fixed map has seen, by every fourth
///   of them and by means of 2 x 2 shifts. Unrelated poses of laser maps have that mean and that spread; the
///   power is more than 0.5, since neighbouring walls tell nearly the same. Poses of n below
///   kLeastSeenSamples are not looked at.
/// PoseCandidate::score is in 256ths of a standard deviation. The same bits on every machine and for any
/// number of threads. Throws std::invalid_argument for options that make no sense. Runs in the calling TBB
/// arena. O(rotations * samples * translations).
std::vector<PoseCandidate> search_thoroughly(const WallMap& fixed, const WallMap& moving,
                                             const ThoroughSearchOptions& options = {});

}  // namespace gridmerge
