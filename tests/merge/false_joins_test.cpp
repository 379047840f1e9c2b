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

/// One map that each of the others lies on, at a place of its own.
JoinProblem star(const std::vector<double>& odds) {
  JoinProblem problem;
  problem.maps.assign(odds.size() + 1, {{{0.0, 0.0}, 5.0, 20.0}});
  for (std::size_t i = 0; i < odds.size(); ++i)
    problem.pairs.push_back(
        {0, i + 1, {CandidateJoin{{50.0 * static_cast<double>(i), 0.0, 0.0}, odds[i], 0.1}}});
  return problem;
}

/// Where all are as sure, a budget that has room for some has to keep some.
TEST(ConsistentSetWithin, OfEquallySureJoinsKeepsAsManyAsFit) {
  const std::vector<double> odds(20, 4.0);
  for (const JoinProblem& problem : {lone_pairs(odds), star(odds)}) {
    const ConsistentSet all = find_consistent_set(problem, 0.8);
    ASSERT_EQ(problem.maps.size() - all.groups.size(), 20U);
    for (const double share : {0.9, 0.5, 0.1}) {
      const double budget = share * expected_false_joins(all);
      const ConsistentSet found = find_consistent_set_within(problem, 0.8, budget);
      const std::size_t joins = problem.maps.size() - found.groups.size();
      EXPECT_LE(expected_false_joins(found), budget);
      EXPECT_NEAR(static_cast<double>(joins), 20.0 * share, 1.5);
      EXPECT_EQ(found.over_budget.size(), 20U - joins);
    }
  }
}

/// The maps of each group, for two sets of the same problem.
std::vector<std::size_t> group_of_maps(const ConsistentSet& consistent_set, std::size_t maps) {
  std::vector<std::size_t> group_of(maps);
  for (std::size_t g = 0; g < consistent_set.groups.size(); ++g) {
    for (const PlacedNode& node : consistent_set.groups[g]) group_of[node.map] = g;
  }
  return group_of;
}

/// Maps in one place, of which some pairs are in doubt, and some have a wrong candidate.
JoinProblem drawn(unsigned seed) {
  std::mt19937 random(seed);
  const auto uniform = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  JoinProblem problem;
  std::vector<SE2> T_world_map;
  for (int i = 0; i < 12; ++i) {
    problem.maps.push_back({{{0.0, 0.0}, 8.0, 25.0}});
    T_world_map.push_back({uniform(-30.0, 30.0), uniform(-30.0, 30.0), uniform(-3.0, 3.0)});
  }
  for (std::size_t a = 0; a < 12; ++a) {
    for (std::size_t b = a + 1; b < 12; ++b) {
      if (random() % 3 != 0) continue;
      PairCandidates pair{a, b, {{inverse(T_world_map[a]) * T_world_map[b], uniform(-2.0, 6.0), 0.1}}};
      if (random() % 3 == 0)
        pair.candidates.push_back(
            {{uniform(-30.0, 30.0), uniform(-30.0, 30.0), uniform(-3.0, 3.0)}, uniform(-4.0, 2.0), 0.1});
      problem.pairs.push_back(std::move(pair));
    }
  }
  return problem;
}

TEST(ConsistentSetWithin, ASmallerBudgetOnlyCutsFurtherAndNoMoreThanItHasTo) {
  std::size_t cut = 0;
  for (unsigned seed = 1; seed <= 40; ++seed) {
    const JoinProblem problem = drawn(seed);
    ConsistentSet larger = find_consistent_set(problem, 0.8);
    const double expected = expected_false_joins(larger);
    for (const double share : {0.8, 0.5, 0.2, 0.05}) {
      const ConsistentSet found = find_consistent_set_within(problem, 0.8, share * expected);
      EXPECT_LE(expected_false_joins(found), share * expected) << seed;
      const std::vector<std::size_t> of_larger = group_of_maps(larger, 12),
                                     of_found = group_of_maps(found, 12);
      for (std::size_t a = 0; a < 12; ++a) {
        for (std::size_t b = 0; b < a; ++b) {
          if (of_found[a] != of_found[b]) continue;
          EXPECT_EQ(of_larger[a], of_larger[b]) << seed;
        }
      }
      // With room for just what is expected of it, it is the same.
      const ConsistentSet again = find_consistent_set_within(problem, 0.8, expected_false_joins(found));
      EXPECT_EQ(group_of_maps(again, 12), of_found) << seed;
      cut += found.groups.size() - larger.groups.size();
      larger = found;
    }
  }
  EXPECT_GT(cut, 50U);
}

TEST(ConsistentSetWithin, RefusesABudgetThatIsNone) {
  EXPECT_THROW(find_consistent_set_within({}, 0.8, -0.1), std::invalid_argument);
  EXPECT_THROW(find_consistent_set_within({}, 0.8, std::nan("")), std::invalid_argument);
}

}  // namespace
}  // namespace gridmerge
