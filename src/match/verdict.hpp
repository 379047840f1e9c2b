// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "gridmerge/match/match_result.hpp"
#include "internal_export.hpp"

namespace gridmerge::internal {

/// What a term of the model speaks of.
enum class TermKind {
  amount,   ///< how much the maps have in common
  quality,  ///< how well they agree where both have seen
  rivals,   ///< how far it stands above other poses of the pair
  excuse,   ///< what lets a pose be believed although one of the others is poor
};

/// "amount", "quality", "rivals", "excuse".
const char* name_of(TermKind kind);

/// A term of the model: the one place where its name, meaning and formula stand. Tables, fit and docs follow.
struct GRIDMERGE_INTERNAL_EXPORT VerdictTerm {
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
GRIDMERGE_INTERNAL_EXPORT std::span<const VerdictTerm> verdict_terms();

/// A term of the ranking, which says which of several poses of one pair is the best: the one place where its
/// name and formula stand.
struct RankTerm {
  const char* name;
  const char* formula;  ///< in words, of the names of pose_figures()
  double (*value)(const PoseFigures&);
};

/// Parts of terms: -log of what is missing to 1, of which `floor` is missing from a perfect share; and how
/// well a pose is held in its weakest direction, against its strongest (a corridor slides).
double missing(double share, double floor);
double how_held(const PoseFigures& figures);

/// All of them, in the order of the ranking's weights.
GRIDMERGE_INTERNAL_EXPORT std::span<const RankTerm> rank_terms();

struct VerdictWeight;

/// What ranks poses of a pair and says whether to believe the best one: terms, and what each of them weighs.
struct VerdictModel {
  std::span<const RankTerm> rank_terms;
  std::span<const VerdictWeight> rank_weights;  ///< in the order of rank_terms
  std::span<const VerdictTerm> terms;
  std::span<const VerdictWeight> weights;  ///< in the order of terms
  double bias;                             ///< [nats]
  /// Whether the scale is unknown as well. Then walls may agree on too little however much the maps share.
  bool is_scaled = false;
};

/// The model of maps of one scale: verdict_terms() and rank_terms() with the weights of verdict_model.hpp.
const VerdictModel& rigid_model();

/// What speaks for a pose against others of its pair: the weighted sum of its rank terms [nats]. Quality
/// counts more here than amount, so that a true pose that overlaps little stands before wrong ones that
/// overlap much.
double rank_of(const PoseFigures& figures, const VerdictModel& model = rigid_model());

/// Gives each of several distinct hypotheses of one pair what it has before its rivals: `score_margin` and
/// `stands_out`. All others are its rivals, except those that are near (`are_near`, of two indices) and score
/// less: bent maps have no exact pose, so that a second maximum beside the first says nothing against it.
/// O(hypotheses^2).
void compare_rivals(std::span<PoseFigures> hypotheses,
                    const std::function<bool(std::size_t, std::size_t)>& are_near = {},
                    const VerdictModel& model = rigid_model());

/// What speaks for a pose against "none of these", its rivals left aside: the weighted sum of its terms
/// [nats].
double log_odds_of(const PoseFigures& figures, const VerdictModel& model = rigid_model());

/// The probability of each of several distinct hypotheses of one pair, after compare_rivals(). The best one,
/// b, is that of the largest rank_of(). It has its share among its rivals times the belief in it,
///   p_b = 1 / (1 + exp(-stands_out_b)) * 1 / (1 + exp(-log_odds_of(b))),
/// a nested logit model (McFadden 1978). The others divide what it leaves of the belief by their exp(rank).
/// So two that are equally good share what there is, and the order is that of the ranks. O(hypotheses).
std::vector<double> probabilities_of(std::span<const PoseFigures> hypotheses,
                                     const VerdictModel& model = rigid_model());

/// Whether the maps can slide along each other at hardly any loss, as two pieces of a corridor can:
/// PoseFigures::free_direction says which way.
bool slides(const PoseFigures& figures);

/// Whether it stands so far above all other hypotheses of its pair together that they cannot refuse it.
bool stands_out(const PoseFigures& figures, double accept_probability);

/// Whether the second of two hypotheses, by their probabilities, is nearly as good: the better one would be
/// refused however much the maps had in common.
bool is_near_rival(double best, double next, double accept_probability);

/// Why the first of these hypotheses, which is the best, is refused where `accept_probability` is asked for;
/// `none` if it is not, `nothing_to_compare` if there is no hypothesis.
Reason explain_refusal(std::span<const PoseFigures> hypotheses, double accept_probability,
                       const VerdictModel& model = rigid_model());

}  // namespace gridmerge::internal
