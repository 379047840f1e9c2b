// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <vector>

#include "match/hypotheses.hpp"

namespace gridmerge::internal {

struct LookOptions {
  SearchMethod search = SearchMethod::exhaustive;
  double decided_from = 0.95;            ///< the quick look's best probability that needs no second look
  std::function<void(double)> progress;  ///< as in MatchOptions
  /// What the quick search of the same maps has found, if it was made before: the exhaustive one goes on from
  /// there. Not owned.
  const std::vector<Hypothesis>* quick_look = nullptr;
};

/// Searches all poses, refines them and weighs each: distinct ones, most probable first, with probabilities;
/// without those that on the whole speak against themselves. Runs in the calling TBB arena.
std::vector<Hypothesis> find_hypotheses(const ComparedMaps& maps, const LookOptions& options = {});

}  // namespace gridmerge::internal
