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

/// A pair beyond doubt.
VerdictFeatures clear_pair() {
  VerdictFeatures features;
  features.lead = 40.0;
  features.acceptance_index = 0.98;
  features.wall_lines = 12.0;
  features.score = 5000.0;
  features.nats_per_wall = 1.5;
  features.overlap = 0.6;
  features.common_area = 150.0;
  features.spread = 4.0;
  features.sigma = 0.07;
  features.outliers = 0.1;
  return features;
}

TEST(ProbabilityOf, APairBeyondDoubtIsBelieved) {
  EXPECT_GT(probability_of(clear_pair()), 0.99);
}

TEST(ProbabilityOf, RisesWithWhatSpeaksForThePair) {
  VerdictFeatures fair = clear_pair();
  fair.lead = 10.0;
  fair.acceptance_index = 0.95;
  fair.outliers = 0.2;
  fair.wall_lines = 6.0;
  const auto changed = [&](double VerdictFeatures::*feature, double value) {
    VerdictFeatures other = fair;
    other.*feature = value;
    return probability_of(other);
  };
  const double usual = probability_of(fair);
  EXPECT_GT(changed(&VerdictFeatures::lead, 20.0), usual);
  EXPECT_GT(changed(&VerdictFeatures::acceptance_index, 0.97), usual);
  EXPECT_GT(changed(&VerdictFeatures::wall_lines, 8.0), usual);
  EXPECT_LT(changed(&VerdictFeatures::outliers, 0.35), usual);
}

TEST(ProbabilityOf, ATieIsAtMostEven) {
  VerdictFeatures tie = clear_pair();
  tie.lead = 0.0;
  EXPECT_LE(probability_of(tie), 0.5);
}

TEST(ProbabilityOf, ACornerIsNotEnoughHoweverLongAndClean) {
  VerdictFeatures corner = clear_pair();
  corner.acceptance_index = 1.0;
  corner.outliers = 0.02;
  corner.wall_lines = 2.0;
  EXPECT_LT(probability_of(corner), 0.05);
}

TEST(ProbabilityOf, NothingIsNothing) {
  EXPECT_LT(probability_of({}), 1e-6);
}

TEST(ExplainRefusal, NamesWhatAloneHoldsThePairBack) {
  constexpr double kAccept = 0.95;
  const auto reason = [](auto change) {
    VerdictFeatures features = clear_pair();
    change(features);
    return explain_refusal(features, kAccept);
  };
  EXPECT_EQ(reason([](auto&) {}), Reason::none);
  EXPECT_EQ(reason([](auto& f) { f.lead = 0.5; }), Reason::ambiguous);
  EXPECT_EQ(reason([](auto& f) { f.acceptance_index = 0.8, f.outliers = 0.5, f.nats_per_wall = 0.4; }),
            Reason::contradiction);
  EXPECT_EQ(reason([](auto& f) { f.wall_lines = 1.5, f.spread = 0.5; }), Reason::too_little_overlap);
  EXPECT_EQ(reason([](auto& f) {
              f.lead = 0.5, f.acceptance_index = 0.8, f.outliers = 0.5, f.nats_per_wall = 0.4,
              f.wall_lines = 1.5;
            }),
            Reason::several);
  EXPECT_STREQ(name_of(Reason::ambiguous), "ambiguous");
  EXPECT_STREQ(name_of(Reason::too_little_overlap), "too_little_overlap");
}

}  // namespace
}  // namespace gridmerge
