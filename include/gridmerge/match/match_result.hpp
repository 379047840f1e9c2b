// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "gridmerge/export.hpp"
#include "gridmerge/grid/se2.hpp"

namespace gridmerge {

/// Whether the best hypothesis is believed.
enum class Verdict {
  refused,   ///< it is not: see Reason
  accepted,  ///< it is
};

/// The verdict's one word in every output: "refused" or "accepted".
GRIDMERGE_EXPORT const char* name_of(Verdict verdict);

/// Why a pair was refused: what, were it otherwise, would let the best hypothesis be accepted.
enum class Reason {
  none,                ///< it was accepted
  nothing_to_compare,  ///< a map has nothing to go by, or no pose speaks for the maps
  ambiguous,  ///< another hypothesis explains the maps nearly as well, or the maps slide along each other; of
              ///< unknown scales: or they agree on so few walls that one may, by chance
  contradiction,       ///< the maps disagree where they know the same places
  too_little_overlap,  ///< they agree, but on too little
  several,             ///< more than one of these
  contradicts_others,  ///< of a merge: believed by itself, but not with what the other maps say
  over_budget,  ///< of a merge: the join is likely enough, but MergeOptions::max_false_joins has no room for
                ///< it
};

/// As outputs spell it: "ambiguous", "too_little_overlap", ...; "none" for an accepted pair.
GRIDMERGE_EXPORT const char* name_of(Reason reason);

/// What speaks for a pose of two maps and against it. pose_figures() lists them with their meanings.
struct PoseFigures {
  /// @name Figures
  ///@{

  /// See pose_figures().
  double score = 0.0;
  double score_margin = 0.0;
  double stands_out = 0.0;
  double wall_score = 0.0;
  double seen_walls = 0.0;
  double walls_met = 0.0;
  double walls_met_locally = 0.0;
  double wall_lines = 0.0;
  double seen_things = 0.0;
  double things_met = 0.0;
  double spread = 0.0;
  double held = 0.0;
  double held_most = 0.0;
  double free_direction = 0.0;
  double acceptance_index = 0.0;
  double common_area = 0.0;
  double overlap = 0.0;
  double sigma = 0.0;
  double outliers = 0.0;
  ///@}
};

/// One of the figures: the one place where its name, unit and meaning stand.
struct PoseFigure {
  const char* name;            ///< as outputs spell it
  const char* unit;            ///< "m", "nats", "share", ...
  const char* meaning;         ///< in a few words
  double PoseFigures::*value;  ///< where PoseFigures holds it
};

/// All of them, in the order of PoseFigures.
GRIDMERGE_EXPORT std::span<const PoseFigure> pose_figures();

/// One way in which the moving map may lie on the fixed one.
struct Hypothesis {
  SE2 T_fixed_moving;  ///< between the map frames
  /// Larger is better: the log-likelihood ratio "same place" against "unrelated" [nats].
  double score = 0.0;
  double probability = 0.0;  ///< that this pose is the true one
  PoseFigures figures = {};  ///< what speaks for it
  double scale = 1.0;        ///< by which the moving map is too small, as MatchResult::scale
};

/// A pose of a pair, and what its two maps say of it.
struct PairPose {
  SE2 T_fixed_moving;             ///< between the map frames
  double probability = 0.0;       ///< that it is the true pose
  double acceptance_index = 0.0;  ///< agreement / (agreement + disagreement); 0 when nothing overlaps
  std::int64_t agreement = 0;     ///< cells known in both maps and equal
  std::int64_t disagreement = 0;  ///< cells known in both maps and different
  double overlap = 0.0;           ///< share of the smaller map's known cells that are known in both
};

/// How two maps lie, and whether that is to be believed: the pose is that of the best hypothesis, given for a
/// refused pair too.
struct MatchResult : PairPose {
  Verdict verdict = Verdict::refused;          ///< on the best hypothesis
  Reason reason = Reason::nothing_to_compare;  ///< why it was refused
  double seconds = 0.0;  ///< wall time to the verdict, of prepared maps without preparing
  /// What the moving map is enlarged by before its pose applies: p_fixed = scale * R * p_moving + t, R and t
  /// those of T_fixed_moving. 1 unless MatchOptions::scales asks for others.
  double scale = 1.0;
  /// Distinct, most probable first; empty only when a map has nothing to go by, or none was asked for.
  std::vector<Hypothesis> hypotheses;
};

/// Throws std::invalid_argument, saying what is wrong, for what no match of two maps can have found: a pose
/// or a figure that is not finite, a probability outside [0, 1], a negative count, share or `sigma`, a scale
/// that is not positive, or another verdict or reason than those that there are. O(hypotheses).
GRIDMERGE_EXPORT void validate(const MatchResult& match);

/// The result of the same two maps when the other one is called fixed. O(hypotheses).
GRIDMERGE_EXPORT MatchResult inverse(MatchResult result);

}  // namespace gridmerge
