// SPDX-License-Identifier: Apache-2.0
#include "match/scaled_verdict.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "match/hypotheses.hpp"
#include "match/scaled_verdict_model.hpp"

namespace gridmerge {

using namespace internal;
namespace {

/// A bent map on its plan.
Hypothesis clear_pose() {
  Hypothesis one;
  one.score = one.figures.score = 9000.0;
  one.figures.seen_walls = 700.0;
  one.figures.walls_met_locally = 0.74;
  one.figures.wall_lines = 19.0;
  one.figures.held = 2500.0;
  one.figures.held_most = 3200.0;
  one.scale = 0.83;
  return one;
}

Hypothesis chance_pose() {
  Hypothesis one = clear_pose();
  one.score = one.figures.score = 2500.0;
  one.figures.walls_met_locally = 0.5;
  one.figures.wall_lines = 5.0;
  one.scale = 1.4;
  return one;
}

std::vector<Hypothesis> weighed(std::vector<Hypothesis> hypotheses, std::size_t levels = 48) {
  weigh_scaled(hypotheses, levels, [](const Hypothesis&, const Hypothesis&) { return false; });
  return hypotheses;
}

TEST(ScaledVerdict, EachTermHasItsWeight) {
  const VerdictModel model = scaled_model(48);
  ASSERT_EQ(model.terms.size(), model.weights.size());
  for (std::size_t i = 0; i < model.terms.size(); ++i) {
    EXPECT_EQ(std::string(model.terms[i].name), model.weights[i].term);
    EXPECT_GE(model.weights[i].weight, 0.0);
  }
  ASSERT_EQ(model.rank_terms.size(), model.rank_weights.size());
  for (std::size_t i = 0; i < model.rank_terms.size(); ++i)
    EXPECT_EQ(std::string(model.rank_terms[i].name), model.rank_weights[i].term);
}

TEST(ScaledVerdict, BelievesWhatAgreesOnMuchAndNotAChanceFit) {
  const std::vector<Hypothesis> both = weighed({chance_pose(), clear_pose()});
  EXPECT_EQ(both[0].scale, 0.83);
  EXPECT_GE(both[0].probability, 0.95);
  EXPECT_LE(both[1].probability, 0.05);
  EXPECT_LT(weighed({chance_pose()})[0].probability, 0.5);
}

TEST(ScaledVerdict, AnEqualPoseOfAnotherScaleIsARival) {
  Hypothesis other = clear_pose();
  other.scale = 1.1;
  const std::vector<Hypothesis> both = weighed({clear_pose(), other});
  EXPECT_LE(both[0].probability, 0.5);
  EXPECT_NEAR(both[0].figures.stands_out, 0.0, 1e-6);
}

TEST(ScaledVerdict, MoreLevelsThanWereFittedAreBelievedLess) {
  const double fitted = weighed({clear_pose()}, 48)[0].probability;
  EXPECT_EQ(weighed({clear_pose()}, 1)[0].probability, fitted);
  double before = fitted;
  for (const std::size_t levels : {60, 96, 200}) {
    const double now = weighed({clear_pose()}, levels)[0].probability;
    EXPECT_LT(now, before);
    before = now;
  }
  EXPECT_NEAR(scaled_model(96).bias, scaled_model(48).bias - std::log(2.0), 1e-12);
}

Reason reason_of(const PoseFigures& changed) {
  Hypothesis one = clear_pose();
  one.figures = changed;
  const std::vector<Hypothesis> all = weighed({one});
  return explain_refusal(figures_of(all), 0.95, scaled_model(48));
}

TEST(ScaledVerdict, NamesLittleOverlapOnlyWhereMoreOfItWouldDo) {
  PoseFigures few_walls = clear_pose().figures;
  few_walls.walls_met_locally = 0.9;
  few_walls.wall_lines = 3.0;
  few_walls.overlap = 0.2;
  EXPECT_EQ(reason_of(few_walls), Reason::too_little_overlap);
  few_walls.overlap = 0.98;
  few_walls.wall_lines = 1.2;
  few_walls.walls_met_locally = 0.99;
  EXPECT_EQ(reason_of(few_walls), Reason::ambiguous);

  PoseFigures bent = clear_pose().figures;
  bent.walls_met_locally = 0.62;
  bent.wall_lines = 11.0;
  bent.overlap = 0.98;
  EXPECT_EQ(reason_of(bent), Reason::contradiction);
  bent.overlap = 0.3;
  EXPECT_EQ(reason_of(bent), Reason::too_little_overlap);

  PoseFigures loose = clear_pose().figures;  // of which the rest would hold what slides
  loose.walls_met_locally = 0.6;
  loose.wall_lines = 9.0;
  loose.held = 0.2 * loose.held_most;
  loose.overlap = 0.3;
  EXPECT_EQ(reason_of(loose), Reason::too_little_overlap);
  loose.overlap = 0.98;
  EXPECT_EQ(reason_of(loose), Reason::contradiction);

  PoseFigures hopeless = chance_pose().figures;
  hopeless.wall_lines = 1.0;
  hopeless.walls_met_locally = 0.2;
  hopeless.overlap = 0.98;
  EXPECT_EQ(reason_of(hopeless), Reason::several);
}

TEST(ScaledVerdict, AnEqualPoseOfAnotherScaleMakesItAmbiguous) {
  Hypothesis here = clear_pose(), there = clear_pose();
  here.figures.overlap = there.figures.overlap = 0.3;
  there.scale = 1.1;
  const std::vector<Hypothesis> both = weighed({here, there});
  EXPECT_EQ(explain_refusal(figures_of(both), 0.95, scaled_model(48)), Reason::ambiguous);
}

TEST(ScaledVerdict, FiguresOutOfAllBoundsHaveAProbability) {
  Hypothesis odd;
  odd.score = odd.figures.score = 1e-3;
  odd.figures.walls_met_locally = 1.0;
  odd.figures.held = -100.0;
  const std::vector<Hypothesis> weighed_odd = weighed({odd});
  EXPECT_GE(weighed_odd[0].probability, 0.0);
  EXPECT_LE(weighed_odd[0].probability, 1.0);
  EXPECT_TRUE(weighed({}).empty());
}

}  // namespace
}  // namespace gridmerge
