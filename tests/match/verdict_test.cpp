// SPDX-License-Identifier: Apache-2.0
#include "gridmerge/match/verdict.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace gridmerge {
namespace {

TEST(VerdictFeatures, LeadIsTheMarginInUnitsOfItsNoise) {
  EXPECT_DOUBLE_EQ(make_verdict_features({400.0, 100.0}, 0.9).lead, 15.0);
  EXPECT_DOUBLE_EQ(make_verdict_features({400.0}, 0.9).lead, 20.0);
  EXPECT_DOUBLE_EQ(make_verdict_features({}, 0.9).lead, 0.0);
  EXPECT_DOUBLE_EQ(make_verdict_features({400.0, 400.0}, 0.9).lead, 0.0);
}

TEST(ProbabilityOf, RisesWithTheLeadAndWithTheAcceptanceIndex) {
  double last = 0.0;
  for (const double lead : {1.0, 5.0, 10.0, 20.0, 40.0}) {
    const double probability = probability_of({lead, 0.95});
    EXPECT_GT(probability, last);
    EXPECT_LT(probability, 1.0 + 1e-12);
    last = probability;
  }
  EXPECT_GT(probability_of({20.0, 0.97}), probability_of({20.0, 0.9}));
}

TEST(ProbabilityOf, NoLeadIsNoTrust) {
  EXPECT_EQ(probability_of({0.0, 1.0}), 0.0);
}

}  // namespace
}  // namespace gridmerge
