// SPDX-License-Identifier: Apache-2.0
#include "candidates.hpp"

#include <algorithm>
#include <cmath>

namespace gridmerge {

namespace {

constexpr double kLeastProbability = 1e-3;
constexpr double kLeastDoubt = 1e-5;  // the model is not surer of anything

/// Among three or more maps: what the odds of a pair are multiplied by, and how many sure matches are of
/// places that repeat. With these, 120 simulated teams have as many false joins as their budgets allow, and
/// of members from a probability of 0.98 on, 99 in 100 are right (benchmark/teams.py).
constexpr double kPriorOdds = 0.4;
constexpr double kRepeats = 0.005;

/// A pose is off by about so many standard deviations of the walls that agree on it: bent maps have no exact
/// one.
constexpr double kDeviationsOfWalls = 2.0;

}  // namespace

std::vector<CandidateJoin> candidate_joins(const MatchResult& match, std::size_t maps) {
  const bool of_many = maps > 2;
  std::vector<CandidateJoin> candidates;
  for (const Hypothesis& hypothesis : match.hypotheses) {
    if (hypothesis.probability < kLeastProbability) continue;
    const double doubt = std::max(1.0 - hypothesis.probability, kLeastDoubt) + (of_many ? kRepeats : 0.0);
    const double odds = (of_many ? kPriorOdds : 1.0) * hypothesis.probability / doubt;
    candidates.push_back(
        {hypothesis.T_fixed_moving, std::log(odds), kDeviationsOfWalls * hypothesis.figures.sigma});
  }
  return candidates;
}

}  // namespace gridmerge
