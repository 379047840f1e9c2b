// SPDX-License-Identifier: Apache-2.0
#include "gridmerge/merge/merge_result.hpp"

#include <gtest/gtest.h>

#include <cstddef>
#include <iterator>
#include <set>
#include <string>
#include <vector>

namespace gridmerge {
namespace {

constexpr Reason kReasons[] = {
    Reason::nothing_to_compare, Reason::ambiguous,   Reason::contradiction, Reason::too_little_overlap,
    Reason::contradicts_others, Reason::over_budget, Reason::several};

/// As many maps as are told, all of them left out for `reason`.
MergeResult with_left_out(std::size_t count, Reason reason) {
  MergeResult result;
  for (std::size_t i = 0; i < count; ++i) result.left_out.push_back({i, reason});
  return result;
}

TEST(MergeResult, SaysOfEachReasonForWhichAMapIsLeftOutWhatItIs) {
  std::set<std::string> words;
  for (const Reason reason : kReasons) {
    const MergeResult result = with_left_out(2, reason);
    words.insert(explain(result, result.left_out.front()));
  }
  EXPECT_EQ(words.size(), std::size(kReasons));
}

TEST(MergeResult, AMapAloneHasNoOtherToBeMergedWith) {
  const MergeResult alone = with_left_out(1, Reason::nothing_to_compare);
  const std::string there_is_none = "there is no other map to merge it with";
  EXPECT_EQ(explain(alone, alone.left_out.front()), there_is_none);
  for (const std::size_t count : {2u, 3u}) {
    const MergeResult several = with_left_out(count, Reason::nothing_to_compare);
    EXPECT_NE(explain(several, several.left_out.front()), there_is_none) << count;
  }
  MergeResult beside = alone;  // other maps were merged
  beside.components.emplace_back();
  EXPECT_NE(explain(beside, beside.left_out.front()), there_is_none);
  const MergeResult doubtful = with_left_out(1, Reason::ambiguous);
  EXPECT_NE(explain(doubtful, doubtful.left_out.front()), there_is_none);
}

TEST(MergeResult, SaysOfEachReasonForWhichAPartIsNotOnThePlanWhatItIs) {
  std::set<std::string> words;
  PlanPart part;
  for (const Reason reason : kReasons) {
    part.reason = reason;
    words.insert(explain(part));
    EXPECT_FALSE(part.on_plan());
  }
  EXPECT_EQ(words.size(), std::size(kReasons));
  part.reason = Reason::none;
  EXPECT_TRUE(part.on_plan());
}

TEST(MergeResult, APlanHasTheMapsAndTheProbabilityOfThePartsThatAreOnIt) {
  PlanPlacement plan;
  EXPECT_EQ(plan.probability(), 0.0);
  EXPECT_TRUE(plan.maps_on_plan().empty());
  plan.parts = {{{0, 3}, {}, 1.0, 0.96, Reason::none},
                {{1}, {}, 1.0, 0.999, Reason::over_budget},
                {{2, 4}, {}, 1.0, 0.98, Reason::none},
                {{5}, {}, 1.0, 0.97, Reason::none}};
  EXPECT_EQ(plan.maps_on_plan(), (std::vector<std::size_t>{0, 3, 2, 4, 5}));
  EXPECT_EQ(plan.probability(), 0.98);
}

TEST(MergeResult, EachOutcomeOfAJoinHasAName) {
  std::set<std::string> names;
  for (const JoinOutcome outcome : {JoinOutcome::accepted, JoinOutcome::rescued, JoinOutcome::rejected,
                                    JoinOutcome::known, JoinOutcome::refused})
    names.insert(name_of(outcome));
  EXPECT_EQ(names, (std::set<std::string>{"accepted", "rescued", "rejected", "known", "refused"}));
}

}  // namespace
}  // namespace gridmerge
