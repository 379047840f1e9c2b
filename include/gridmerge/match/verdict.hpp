// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "gridmerge/match/pose_figures.hpp"

namespace gridmerge {

enum class Verdict { refused, accepted };

/// The verdict's one word in every output: "refused" or "accepted".
const char* name_of(Verdict verdict);

/// Why a pair was refused: what, were it otherwise, would let the best hypothesis be accepted.
enum class Reason {
  none,                ///< it was accepted
  nothing_to_compare,  ///< a map has nothing to go by, or no pose speaks for the maps
  ambiguous,      ///< another hypothesis explains the maps nearly as well, or the maps slide along each other
  contradiction,  ///< the maps disagree where they know the same places
  too_little_overlap,  ///< they agree, but on too little
  several,             ///< more than one of these
  contradicts_others,  ///< of a merge: believed by itself, but not with what the other maps say
};

/// As outputs spell it: "ambiguous", "too_little_overlap", ...; "none" for an accepted pair.
const char* name_of(Reason reason);

/// What a term of the model speaks of.
enum class TermKind {
  amount,   ///< how much the maps have in common
  quality,  ///< how well they agree where both have seen
  excuse,   ///< what lets a pose be believed although one of the others is poor
};

/// "amount", "quality", "excuse".
const char* name_of(TermKind kind);

/// A term of the model: the one place where its name, meaning and formula stand. Tables, fit and docs follow.
struct VerdictTerm {
  const char* name;
  const char* formula;  ///< in words, of the names of pose_figures()
  TermKind kind;
  double least;  ///< bounds: beyond them a figure says how large or clean maps are, not whether they belong
                 ///< together
  double most;
  double (*raw)(const PoseFigures&);  ///< before the bounds

  double operator()(const PoseFigures& figures) const;  ///< larger speaks for the pose
};

/// All terms, in the order of the model's weights.
std::span<const VerdictTerm> verdict_terms();

/// Gives each of several distinct hypotheses of one pair what it has before its rivals: `lead` and
/// `next_acceptance_index`. All others are its rivals, except those that are near (`are_near`, of two
/// indices) and score less: bent maps have no exact pose, so that a second maximum beside the first says
/// nothing against it. O(hypotheses^2).
void compare_rivals(std::span<PoseFigures> hypotheses,
                    const std::function<bool(std::size_t, std::size_t)>& are_near = {});

/// What speaks for a pose against "none of these", its rivals' odds left aside: the weighted sum of its terms
/// [nats].
double log_odds_of(const PoseFigures& figures);

/// The probability of each of several distinct hypotheses of one pair: exp(s_i) / (1 + sum_j exp(s_j)), with
/// s = log_odds_of() and 1 for "none of these" (a conditional logit model, McFadden 1974). So two that are
/// equally good share what there is, and several poor ones do not add up to a good one. O(hypotheses).
std::vector<double> probabilities_of(std::span<const PoseFigures> hypotheses);

/// Whether the maps can slide along each other at hardly any loss, as two pieces of a corridor can:
/// PoseFigures::free_direction says which way.
bool slides(const PoseFigures& figures);

/// Why the first of these hypotheses, which is the best, is refused where `accept_probability` is asked for;
/// `none` if it is not, `nothing_to_compare` if there is no hypothesis.
Reason explain_refusal(std::span<const PoseFigures> hypotheses, double accept_probability);

}  // namespace gridmerge
