// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

#include "search/exhaustive.hpp"

namespace gridmerge::internal {

/// As of search_all_poses(), with defaults of its own.
struct ThoroughSearchOptions : ExhaustiveSearchOptions {
  ThoroughSearchOptions() {
    samples = 512;  // at most kMaxThoroughSamples
    max_candidates = 600;
    sigma = 4.0;
  }
};

/// Keeps the 16-bit sums of the search from overflowing.
inline constexpr std::size_t kMaxThoroughSamples = 2000;

/// The score of unrelated poses that see `walls` spreads as walls^0.75: neighbouring walls tell nearly the
/// same, so more than the square root. Square roots are the same on every machine, std::pow() is not.
inline double spread_of(double walls) {
  return std::sqrt(walls) * std::sqrt(std::sqrt(walls));
}

/// Samples that lie where the fixed map has seen, from which on a pose is looked at.
inline constexpr double kMinSeenSamples = 25.0;

/// As search_all_poses(), for maps that share little. Two things differ.
/// - Facings count: the evidence of a wall depends on which way its free side looks (evidence_table()), in
///   sectors of 22.5 degrees.
/// - A score is what a pose scores beyond what unrelated ones do that see as much, in their standard
///   deviations (unnormalised, what overlaps little is lost among what overlaps much by chance):
///     (S + 0.37 n) / (0.48 n^0.75),
///   S the sum of the evidence [nats], n the samples that fall where the fixed map has seen, by every fourth
///   of them and by means of 2 x 2 shifts. Unrelated poses of laser maps have that mean and that spread
///   (spread_of()). Poses of n below kMinSeenSamples are not looked at.
/// PoseCandidate::score is in 256ths of a standard deviation. The same bits for any number of threads, and on
/// other machines as far as search_all_poses() says. Throws std::invalid_argument for options that make no
/// sense. Runs in the calling TBB arena. O(rotations * samples * translations).
std::vector<PoseCandidate> search_thoroughly(const LikelihoodField& fixed, const LikelihoodField& moving,
                                             const ThoroughSearchOptions& options = {});

}  // namespace gridmerge::internal
