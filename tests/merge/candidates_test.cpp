// SPDX-License-Identifier: Apache-2.0
#include "merge/candidates.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace gridmerge {
namespace {

MatchResult match_of(const std::vector<double>& probabilities) {
  MatchResult match;
  for (const double probability : probabilities) {
    Hypothesis hypothesis;
    hypothesis.T_fixed_moving.x = static_cast<double>(match.hypotheses.size());
    hypothesis.probability = probability;
    hypothesis.figures.sigma = 0.1;
    match.hypotheses.push_back(hypothesis);
  }
  return match;
}

double probability_of(const CandidateJoin& candidate) {
  return 1.0 / (1.0 + std::exp(-candidate.log_odds));
}

TEST(CandidateJoins, OfTwoMapsAreAsProbableAsTheirMatchSays) {
  const std::vector<CandidateJoin> joins = candidate_joins(match_of({0.9, 0.05, 0.0005}), 2);
  ASSERT_EQ(joins.size(), 2U);  // one in a thousand is the least
  EXPECT_NEAR(probability_of(joins[0]), 0.9, 1e-9);
  EXPECT_NEAR(probability_of(joins[1]), 0.05, 1e-9);
  EXPECT_EQ(joins[1].T_fixed_moving.x, 1.0);
}

TEST(CandidateJoins, AmongManyMapsASureMatchIsLessSure) {
  const double of_two = probability_of(candidate_joins(match_of({0.999}), 2).front());
  const double of_three = probability_of(candidate_joins(match_of({0.999}), 3).front());
  EXPECT_LT(of_three, of_two);
  EXPECT_EQ(of_three, probability_of(candidate_joins(match_of({0.999}), 30).front()));
  // However sure the match is, a place may repeat.
  EXPECT_LT(probability_of(candidate_joins(match_of({1.0}), 3).front()), 0.99);
  EXPECT_GT(probability_of(candidate_joins(match_of({1.0}), 3).front()), 0.98);
}

}  // namespace
}  // namespace gridmerge
