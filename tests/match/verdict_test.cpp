// SPDX-License-Identifier: Apache-2.0
#include "gridmerge/match/verdict.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace gridmerge {
namespace {

TEST(Lead, IsTheMarginInUnitsOfItsNoise) {
  EXPECT_DOUBLE_EQ(find_lead({400.0, 100.0}), 15.0);
  EXPECT_DOUBLE_EQ(find_lead({400.0}), 20.0);
  EXPECT_DOUBLE_EQ(find_lead({}), 0.0);
  EXPECT_DOUBLE_EQ(find_lead({400.0, 400.0}), 0.0);
}

TEST(ProbabilityOf, RisesWithEveryFeature) {
  double last = 0.0;
  for (const double lead : {1.0, 5.0, 10.0, 20.0, 40.0}) {
    const double probability = probability_of({lead, 0.95, 8.0});
    EXPECT_GT(probability, last);
    EXPECT_LT(probability, 1.0 + 1e-12);
    last = probability;
  }
  EXPECT_GT(probability_of({20.0, 0.97, 8.0}), probability_of({20.0, 0.9, 8.0}));
  EXPECT_GT(probability_of({20.0, 0.95, 4.0}), probability_of({20.0, 0.95, 3.0}));
}

TEST(ProbabilityOf, ATieIsAtMostEven) {
  EXPECT_LT(probability_of({0.0, 1.0, 20.0}), 0.51);
}

TEST(ProbabilityOf, ACornerIsNotEnoughHoweverLongAndClean) {
  EXPECT_LT(probability_of({46.0, 1.0, 2.0}), 0.5);
}

TEST(ExplainRefusal, NamesWhatAloneHoldsThePairBack) {
  constexpr double kAccept = 0.9;
  EXPECT_EQ(explain_refusal({30.0, 0.97, 8.0}, kAccept), Reason::none);
  EXPECT_EQ(explain_refusal({0.1, 0.97, 8.0}, kAccept), Reason::ambiguous);
  EXPECT_EQ(explain_refusal({30.0, 0.6, 8.0}, kAccept), Reason::contradiction);
  EXPECT_EQ(explain_refusal({30.0, 0.97, 2.0}, kAccept), Reason::too_little_overlap);
  EXPECT_EQ(explain_refusal({0.1, 0.6, 2.0}, kAccept), Reason::several);
  EXPECT_STREQ(name_of(Reason::ambiguous), "ambiguous");
  EXPECT_STREQ(name_of(Reason::too_little_overlap), "too_little_overlap");
}

TEST(ProbabilityOf, NothingIsNothing) {
  EXPECT_LT(probability_of({}), 1e-9);
}

}  // namespace
}  // namespace gridmerge
