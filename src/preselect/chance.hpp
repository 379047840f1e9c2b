// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "internal_export.hpp"
#include "preselect/compare.hpp"

namespace gridmerge::internal {

/// Of the pairs that match() joins, the share that looks like unrelated ones: of kinds of buildings to which
/// nothing was fitted, signatures give 35 of 173 a probability below 0.001 (calibration/fit_preselection.py).
inline constexpr double kHiddenShare = 0.2;

/// Log-odds that match() surely finds how two maps lie, from their signatures alone, if such pairs were as
/// common as among those that the model was fitted to [nats]. O(1).
GRIDMERGE_INTERNAL_EXPORT double log_odds_of_joining(const SignatureMatch& match, const Signature& fixed,
                                                     const Signature& moving);

/// What to add to these log-odds so that they fit the set at hand, in which such pairs are rarer or more
/// common: the shift under which their mean probability is the share that it implies (Saerens, Latinne and
/// Decaestecker 2002, "Adjusting the outputs of a classifier to new a priori probabilities", by expectation
/// maximisation). 0 for no pairs. O(pairs) a step, at most 100 steps.
GRIDMERGE_INTERNAL_EXPORT double shift_to_this_set(const std::vector<float>& log_odds);

/// The same log-odds, already shifted, once the pair had a first look which left the two maps apart:
/// `probability` is that of its best hypothesis.
GRIDMERGE_INTERNAL_EXPORT double log_odds_after_a_look(double log_odds, double probability);

}  // namespace gridmerge::internal
