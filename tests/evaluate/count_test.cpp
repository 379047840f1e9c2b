// SPDX-License-Identifier: Apache-2.0
#include "evaluate/count.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "evaluate/known_moments.hpp"

namespace gridmerge {

using namespace internal;
namespace {

MatchOutcome pair_outcome(Verdict verdict, double probability, double error, const std::string& tier = "A") {
  MatchOutcome outcome;
  outcome.fixed = "f";
  outcome.moving = "m";
  outcome.tier = tier;
  outcome.verdict = verdict;
  outcome.probability = probability;
  outcome.error = error;
  outcome.tolerance = 0.5;
  return outcome;
}

MatchOutcome negative_outcome(Verdict verdict, double probability) {
  MatchOutcome outcome;
  outcome.verdict = verdict;
  outcome.probability = probability;
  return outcome;
}

const std::vector<MatchOutcome> kMatches = {
    pair_outcome(Verdict::accepted, 0.99, 0.5),       // right on the tolerance
    pair_outcome(Verdict::accepted, 0.95, 0.51),      // just beyond
    pair_outcome(Verdict::refused, 0.60, 0.1, "B"),   //
    pair_outcome(Verdict::refused, 0.10, 30.0, "B"),  //
    pair_outcome(Verdict::accepted, 0.90, 0.0, ""),   //
    negative_outcome(Verdict::refused, 0.20),         //
    negative_outcome(Verdict::accepted, 0.92),
};

TEST(Counting, OfPairs) {
  EXPECT_EQ(count_pairs(kMatches), (PairCounts{5, 2, 1, 2, 3}));
  EXPECT_EQ(count_pairs({}), PairCounts{});
}

TEST(Counting, AMatchWithNoHypothesisIsNotCorrect) {
  MatchOutcome outcome = pair_outcome(Verdict::refused, 0.0, 0.0);
  outcome.error.reset();
  EXPECT_EQ(count_pairs({outcome}), (PairCounts{1, 0, 0, 1, 0}));
}

TEST(Counting, OfTiers) {
  const auto tiers = count_tiers(kMatches);
  ASSERT_EQ(tiers.size(), 2u);
  EXPECT_EQ(tiers.at("A"), (PairCounts{2, 1, 1, 0, 1}));
  EXPECT_EQ(tiers.at("B"), (PairCounts{2, 0, 0, 2, 1}));
}

TEST(Counting, OfNegatives) {
  EXPECT_EQ(count_negatives(kMatches).total, 2u);
  EXPECT_EQ(count_negatives(kMatches).accepted, 1u);
}

TEST(Counting, OfTimes) {
  std::vector<MatchOutcome> matches(11);
  for (int i = 0; i <= 10; ++i) matches[static_cast<std::size_t>(i)].seconds = (i * 7 % 11) * 0.1;
  const TimeSummary eleven = summarize_times(matches);
  EXPECT_DOUBLE_EQ(eleven.median, 0.5);
  EXPECT_DOUBLE_EQ(eleven.p90, 0.9);
  EXPECT_DOUBLE_EQ(eleven.max, 1.0);

  matches.resize(2);
  matches[0].seconds = 3.0;
  matches[1].seconds = 1.0;
  EXPECT_DOUBLE_EQ(summarize_times(matches).median, 2.0);
  EXPECT_DOUBLE_EQ(summarize_times(matches).p90, 2.8);
  EXPECT_EQ(summarize_times({}).max, 0.0);
}

TEST(Counting, ByThreshold) {
  const auto sweep = sweep_thresholds(kMatches, {0.0, 0.9, 0.95, 1.0});
  const auto expect = [&](std::size_t i, std::size_t correct, std::size_t wrong, std::size_t negatives) {
    EXPECT_EQ(sweep[i].correct, correct) << i;
    EXPECT_EQ(sweep[i].wrong, wrong) << i;
    EXPECT_EQ(sweep[i].negatives, negatives) << i;
  };
  ASSERT_EQ(sweep.size(), 4u);
  expect(0, 3, 2, 2);
  expect(1, 2, 1, 1);
  expect(2, 1, 1, 0);
  expect(3, 0, 0, 0);
}

TEST(Counting, RocAreaIsTheShareOfRightOrderings) {
  // Right: 0.99, 0.60, 0.90. Not: 0.95, 0.10, 0.20, 0.92. Of 12 orderings, 4 + 2 + 2 are right.
  EXPECT_DOUBLE_EQ(roc_area(kMatches), 8.0 / 12.0);
  EXPECT_DOUBLE_EQ(
      roc_area({pair_outcome(Verdict::refused, 0.5, 0.0), negative_outcome(Verdict::refused, 0.5)}), 0.5);
  EXPECT_TRUE(std::isnan(roc_area({pair_outcome(Verdict::refused, 0.5, 0.0)})));
}

// Maps whose true poses and estimated ones differ as each test says; a spread of 4 m makes turns count too.
class Sets : public testing::Test {
 protected:
  static TrueSet set_of(const std::vector<SE2>& truth) {
    TrueSet set;
    set.name = "s";
    for (const SE2& T : truth) set.members.push_back({{}, T, 0.5});
    return set;
  }

  static Component component_of(const std::vector<Member>& members) {
    Component component;
    component.members = members;
    return component;
  }

  static void expect(const SetOutcome& outcome, std::size_t correct, std::size_t wrong,
                     std::size_t left_out) {
    EXPECT_EQ(outcome.correct, correct);
    EXPECT_EQ(outcome.wrong, wrong);
    EXPECT_EQ(outcome.left_out, left_out);
    EXPECT_EQ(outcome.maps, correct + wrong + left_out);
  }

  const std::vector<SE2> truth_ = {{0, 0, 0}, {10, 0, 1}, {0, 10, -2}, {5, 5, 3}};
  const TrueSet set_ = set_of(truth_);
  const std::vector<KnownMoments> moments_{4, KnownMoments{{1.0, 2.0}, 16.0}};
};

TEST_F(Sets, AreCompleteInWhateverFrame) {
  const SE2 T_component_set{3, -4, 0.7};
  MergeResult result;
  result.components = {component_of({{2, T_component_set * truth_[2]},
                                     {0, T_component_set * truth_[0]},
                                     {3, T_component_set * truth_[3]},
                                     {1, T_component_set * truth_[1]}})};
  const SetOutcome outcome = judge_set(set_, moments_, result);
  expect(outcome, 4, 0, 0);
  EXPECT_TRUE(outcome.complete());
  EXPECT_EQ(outcome.name, "s");
}

TEST_F(Sets, AMisplacedFirstMemberIsTheOneThatIsWrong) {
  MergeResult result;
  result.components = {
      component_of({{0, truth_[0] * SE2{3, 0, 0}}, {1, truth_[1]}, {2, truth_[2]}, {3, truth_[3]}})};
  const SetOutcome outcome = judge_set(set_, moments_, result);
  expect(outcome, 3, 1, 0);
  EXPECT_FALSE(outcome.complete());
}

TEST_F(Sets, ATurnOnTheSpotIsWrong) {
  MergeResult result;
  const SE2 about_centroid = SE2{1, 2, 0} * SE2{0, 0, 0.3} * SE2{-1, -2, 0};
  result.components = {component_of({{0, truth_[0]}, {1, truth_[1]}, {2, truth_[2] * about_centroid}})};
  result.left_out = {{3}};
  expect(judge_set(set_, moments_, result), 2, 1, 1);
}

TEST_F(Sets, ComponentsAreJudgedEachByItself) {
  MergeResult result;
  const SE2 elsewhere{100, 100, 2};
  result.components = {component_of({{0, truth_[0]}, {1, truth_[1]}}),
                       component_of({{2, elsewhere * truth_[2]}, {3, elsewhere * truth_[3]}})};
  expect(judge_set(set_, moments_, result), 4, 0, 0);

  result.components[1].members[1].T_component_map.x += 5.0;
  expect(judge_set(set_, moments_, result), 3, 1, 0);
}

TEST_F(Sets, AMapAloneIsLeftOut) {
  MergeResult result;
  result.components = {component_of({{0, truth_[0]}, {1, truth_[1]}}), component_of({{2, truth_[2]}})};
  result.left_out = {{3}};
  expect(judge_set(set_, moments_, result), 2, 0, 2);
  expect(judge_set(set_, moments_, MergeResult{}), 0, 0, 4);
}

TEST_F(Sets, EachMapHasItsOwnTolerance) {
  TrueSet set = set_;
  set.members[1].tolerance = 2.0;
  MergeResult result;
  result.components = {component_of({{0, truth_[0]}, {1, SE2{1.5, 0, 0} * truth_[1]}, {2, truth_[2]}})};
  expect(judge_set(set, moments_, result), 3, 0, 1);
  expect(judge_set(set_, moments_, result), 2, 1, 1);
  // Nor does a map borrow that of the one it is compared with.
  set = set_;
  set.members[0].tolerance = 2.0;
  expect(judge_set(set, moments_, result), 2, 1, 1);
}

TEST_F(Sets, AreSummed) {
  const SetCounts counts = count_sets({{"a", 3, 3, 0, 0}, {"b", 6, 3, 1, 2}, {"c", 2, 0, 0, 2}});
  EXPECT_EQ(counts.total, 3u);
  EXPECT_EQ(counts.maps, 11u);
  EXPECT_EQ(counts.maps_correct, 6u);
  EXPECT_EQ(counts.maps_wrong, 1u);
  EXPECT_EQ(counts.maps_left_out, 4u);
  EXPECT_EQ(counts.complete, 1u);
}

}  // namespace
}  // namespace gridmerge
