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
};

/// What a pose promises before its dear figures are known: the quality of its walls and of its cells.
double promise(const Evidence& walls, double acceptance_index);

/// What a look finds most promising, not judged yet: distinct poses between the grid frames [cells]. The
/// quick one finds what overlaps much; the thorough one, in a few times its time, what overlaps little, too.
/// `report` is told shares of the work, in [0, 1].
std::vector<SE2> propose_quickly(const ComparedMaps& maps, const PoseJudge& judge,
                                 const std::function<void(double)>& report);
std::vector<SE2> propose_thoroughly(const ComparedMaps& maps, const PoseJudge& judge,
                                    const std::function<void(double)>& report);

/// Searches all poses, refines them and weighs each: distinct ones, most probable first, with probabilities;
/// without those that on the whole speak against themselves. Runs in the calling TBB arena.
std::vector<Hypothesis> find_hypotheses(const ComparedMaps& maps, const LookOptions& options = {});

}  // namespace gridmerge::internal
