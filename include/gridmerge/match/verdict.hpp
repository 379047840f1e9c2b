// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

namespace gridmerge {

enum class Verdict { refused, accepted };

/// The verdict's one word in every output: "refused" or "accepted".
const char* name_of(Verdict verdict);

/// Why a pair was refused: what, were it otherwise, would let the best hypothesis be accepted.
enum class Reason {
  none,                ///< it was accepted
  nothing_to_compare,  ///< a map has nothing to go by, or no pose speaks for the maps
  ambiguous,           ///< another distinct hypothesis explains the maps nearly as well
  contradiction,       ///< the maps disagree where they know the same places
  too_little_overlap,  ///< they agree, but on too little
  several,             ///< more than one of these
  contradicts_others,  ///< of a merge: believed by itself, but not with what the other maps say
};

/// As outputs spell it: "ambiguous", "too_little_overlap", ...; "none" for an accepted pair.
const char* name_of(Reason reason);

/// What speaks for the best hypothesis and against it. Not all of it enters the probability; the rest is for
/// who fits a model of their own (gridmerge evaluate --features).
struct VerdictFeatures {
  /// (best - second) / sqrt(best), of the scores of distinct hypotheses [sqrt(nats)]; the second counts 0
  /// when there is none. A score is a sum over many places, so chance moves it by about its square root.
  double lead = 0.0;
  double acceptance_index = 0.0;
  double wall_lines = 0.0;  ///< WallSupport::lines
  double score = 0.0;       ///< [nats]
  double nats_per_wall =
      0.0;               ///< the evidence of walls for a wall point that lies where the other map has seen
  double overlap = 0.0;  ///< share of the smaller map's known cells that are known in both
  double common_area = 0.0;        ///< known in both [m^2]
  double spread = 0.0;             ///< WallSupport::spread [m]
  double sigma = 0.0;              ///< of the error model that explains the maps best [m]
  double outliers = 0.0;           ///< of that model
  double walls_met = 0.0;          ///< WallsMet::rigidly
  double walls_met_locally = 0.0;  ///< WallsMet::locally
};

/// (best - second) / sqrt(best), from the scores of distinct hypotheses, best first, all positive.
double find_lead(const std::vector<double>& scores);

/// Probability that the best hypothesis is the true pose: a logistic model of the lead, the lines of wall and
/// the walls that meet locally (with all of which it rises) and rigidly, fitted to simulated maps by
/// calibration/fit.py. Without a lead it is 1/2 at most: another hypothesis is as good. On fewer than four
/// lines of wall it is next to nothing. See docs/verdict.md for how well it means what it says.
double probability_of(const VerdictFeatures& features);

/// Probability that the truth is among the first few hypotheses, of which the best scored `best` and the one
/// after them `next`: probability_of() with the lead that the best has over that one.
double probability_among(const VerdictFeatures& features, double best, double next);

/// Why a best hypothesis with these features is refused where `accept_probability` is asked for: the first of
/// ambiguous, contradiction and too_little_overlap that alone holds it back; `several` if no single one does;
/// `none` if it is not refused.
Reason explain_refusal(const VerdictFeatures& features, double accept_probability);

}  // namespace gridmerge
