// SPDX-License-Identifier: Apache-2.0
#include "merge/candidates.hpp"

#include <algorithm>
#include <cmath>

namespace gridmerge::internal {

namespace {

constexpr double kMinDoubt = 1e-5;  // the model is not surer of anything

}  // namespace

std::vector<CandidateJoin> candidate_joins(const MatchResult& match) {
  std::vector<CandidateJoin> candidates;
  for (const Hypothesis& hypothesis : match.hypotheses) {
    if (hypothesis.probability < kMinCandidateProbability) continue;
    const double doubt = std::max(1.0 - hypothesis.probability, kMinDoubt);
    candidates.push_back({hypothesis.T_fixed_moving, std::log(hypothesis.probability / doubt),
                          kDeviationsOfWalls * hypothesis.figures.sigma});
  }
  return candidates;
}

}  // namespace gridmerge::internal
