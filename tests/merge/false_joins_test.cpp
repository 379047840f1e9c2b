// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>
#include <stdexcept>
#include <vector>

#include "merge/consistent_set.hpp"

namespace gridmerge {

using namespace internal;
namespace {

/// Pairs of maps that have nothing to do with each other, each with one candidate of its own odds.
JoinProblem lone_pairs(const std::vector<double>& odds) {
  JoinProblem problem;
  problem.maps.assign(2 * odds.size(), {{{0.0, 0.0}, 5.0, 20.0}});
  for (std::size_t i = 0; i < odds.size(); ++i)
    problem.pairs.push_back({2 * i, 2 * i + 1, {CandidateJoin{{1.0, 0.0, 0.0}, odds[i], 0.1}}});
  return problem;
}

TEST(ConsistentSetWithin, MakesAsManyJoinsAsTheBudgetOfFalseOnesAllows) {
  const JoinProblem problem = lone_pairs({2.5, 4.0, 5.5});  // doubts of 0.18, 0.056 and 0.022
  const auto joins = [&](double budget) {
    return 6 - find_consistent_set_within(problem, 0.8, budget).groups.size();
  };
  EXPECT_EQ(joins(1.0), 3U);
  EXPECT_EQ(joins(0.1), 2U);
  EXPECT_EQ(joins(0.03), 1U);
  EXPECT_EQ(joins(0.0), 0U);
  const auto over_budget = [&](double budget) {
    return find_consistent_set_within(problem, 0.8, budget).over_budget.size();
  };
  EXPECT_EQ(over_budget(1.0), 0U);
  EXPECT_EQ(over_budget(0.1), 1U);
  EXPECT_EQ(over_budget(0.0), 3U);
  for (const double budget : {1.0, 0.1, 0.03, 0.001, 0.0})
    EXPECT_LE(expected_false_joins(find_consistent_set_within(problem, 0.8, budget)), budget);
}

RC_GTEST_PROP(ConsistentSetWithin, IsFilledBySurestPairs, ()) {
  const auto steps = *rc::gen::resize(30, rc::gen::unique<std::vector<int>>(rc::gen::inRange(0, 300)));
  std::vector<double> odds;
  for (const int step : steps) odds.push_back(4.0 + 0.01 * step);
  const JoinProblem problem = lone_pairs(odds);
  std::vector<double> doubts;  // in each pair, surest first
  for (const NodeGroup& group : find_consistent_set(problem, 0.8).groups)
    doubts.push_back(1.0 - group.front().probability);
  RC_ASSERT(doubts.size() == steps.size());
  std::sort(doubts.begin(), doubts.end());
  const double budget = 0.001 * *rc::gen::inRange(0, 200);
  double sum = 0.0;
  std::size_t fitting = 0;
  while (fitting < doubts.size() && sum + doubts[fitting] <= budget) sum += doubts[fitting++];
  const ConsistentSet found = find_consistent_set_within(problem, 0.8, budget);
  RC_ASSERT(2 * steps.size() - found.groups.size() == fitting);
  RC_ASSERT(found.over_budget.size() == steps.size() - fitting);
}

/// Doubts that are summed in another order may fit where they did not: the least sure pair goes, no other.
TEST(ConsistentSetWithin, CutsTheLeastSurePairWhereSumsDifferByRounding) {
  std::vector<double> odds;
  for (int i = 0; i < 24; ++i) odds.push_back(4.0 + 0.01 * i);  // with sums above 0.5, which are rounded
  std::mt19937 random(1);
  JoinProblem problem;
  double budget = 0.0, expected = 0.0;
  for (int tries = 0; tries < 100 && !(budget < expected); ++tries) {
    std::shuffle(odds.begin(), odds.end(), random);
    problem = lone_pairs(odds);
    const ConsistentSet all = find_consistent_set(problem, 0.8);
    expected = expected_false_joins(all);
    std::vector<double> doubts;  // surest first
    for (const NodeGroup& group : all.groups) {
      for (const PlacedNode& node : group) doubts.push_back(0.5 * (1.0 - node.probability));
    }
    std::sort(doubts.begin(), doubts.end());
    budget = std::accumulate(doubts.begin(), doubts.end(), 0.0);
  }
  ASSERT_LT(budget, expected) << "no order of the pairs is of use to this test";
  const ConsistentSet found = find_consistent_set_within(problem, 0.8, budget);
  ASSERT_EQ(found.over_budget.size(), 1U);
  EXPECT_EQ(odds[found.over_budget[0]], 4.0);
}

TEST(ConsistentSetWithin, RefusesABudgetThatIsNone) {
  EXPECT_THROW(find_consistent_set_within({}, 0.8, -0.1), std::invalid_argument);
  EXPECT_THROW(find_consistent_set_within({}, 0.8, std::nan("")), std::invalid_argument);
}

}  // namespace
}  // namespace gridmerge
