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
  features.walls_met = 0.88;
  features.walls_met_locally = 0.93;
  return features;
}

TEST(ProbabilityOf, APairBeyondDoubtIsBelieved) {
  EXPECT_GT(probability_of(clear_pair()), 0.99);
}

TEST(ProbabilityOf, RisesWithWhatSpeaksForThePair) {
  VerdictFeatures fair = clear_pair();
  fair.lead = 10.0;
  fair.walls_met_locally = 0.85;
  fair.wall_lines = 6.0;
  const auto changed = [&](double VerdictFeatures::*feature, double value) {
    VerdictFeatures other = fair;
    other.*feature = value;
    return probability_of(other);
  };
  const double usual = probability_of(fair);
  EXPECT_GT(changed(&VerdictFeatures::lead, 20.0), usual);
  EXPECT_GT(changed(&VerdictFeatures::wall_lines, 8.0), usual);
  EXPECT_GT(changed(&VerdictFeatures::walls_met_locally, 0.92), usual);
}

TEST(ProbabilityOf, ATieIsAtMostEven) {
  VerdictFeatures tie = clear_pair();
  tie.lead = 0.0;
  EXPECT_LE(probability_of(tie), 0.5);
}

TEST(ProbabilityOf, ACornerIsNotEnoughHoweverLongAndClean) {
  VerdictFeatures corner = clear_pair();
  corner.walls_met = 1.0;
  corner.walls_met_locally = 1.0;
  corner.wall_lines = 2.0;
  EXPECT_LT(probability_of(corner), 0.05);
}

TEST(ProbabilityAmong, RisesWithTheLeadOverTheNextHypothesis) {
  const VerdictFeatures features = clear_pair();
  EXPECT_GT(probability_among(features, 900.0, 100.0), probability_among(features, 900.0, 800.0));
  VerdictFeatures same = features;
  same.lead = find_lead({900.0, 400.0});
  EXPECT_DOUBLE_EQ(probability_among(features, 900.0, 400.0), probability_of(same));
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
  EXPECT_EQ(reason([](auto& f) { f.walls_met = 0.4, f.walls_met_locally = 0.5; }), Reason::contradiction);
  EXPECT_EQ(reason([](auto& f) { f.wall_lines = 1.5, f.spread = 0.5; }), Reason::too_little_overlap);
  EXPECT_EQ(
      reason([](auto& f) { f.lead = 0.5, f.walls_met = 0.4, f.walls_met_locally = 0.5, f.wall_lines = 1.5; }),
      Reason::several);
  EXPECT_STREQ(name_of(Reason::ambiguous), "ambiguous");
  EXPECT_STREQ(name_of(Reason::too_little_overlap), "too_little_overlap");
}

}  // namespace
}  // namespace gridmerge
