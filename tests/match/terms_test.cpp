// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <string>
#include <utility>
#include <vector>

#include "match/scaled_verdict.hpp"
#include "match/verdict.hpp"
#include "match/verdict_model.hpp"

namespace gridmerge {

using namespace internal;
namespace {

PoseFigures with(std::initializer_list<std::pair<double PoseFigures::*, double>> values) {
  PoseFigures figures;
  for (const auto& [figure, value] : values) figures.*figure = value;
  return figures;
}

template <typename Terms>
const auto& named(const Terms& terms, const std::string& name) {
  return *std::find_if(terms.begin(), terms.end(), [&](const auto& term) { return term.name == name; });
}

double term(const std::string& name, const PoseFigures& figures) {
  return named(verdict_terms(), name)(figures);
}

double rank_term(const std::string& name, const PoseFigures& figures) {
  return named(rank_terms(), name).value(figures);
}

using F = PoseFigures;
constexpr double kNear = 1e-12;

TEST(VerdictTerms, OfAmountAreWhatTheirFormulasSay) {
  EXPECT_NEAR(term("tells apart", with({{&F::wall_lines, 3.2}})), -std::log(1.0 + std::exp(0.9)), kNear);
  EXPECT_NEAR(term("tells apart", with({{&F::wall_lines, 4.5}})), -std::log(1.0 + std::exp(-3.0)), kNear);
  EXPECT_EQ(term("tells apart", with({{&F::wall_lines, -1.0}})), -12.0);
  EXPECT_NEAR(term("held", with({{&F::held, 40.0}, {&F::held_most, 50.0}})), std::log(0.8), kNear);
  EXPECT_NEAR(term("held", with({{&F::held, 0.5}, {&F::held_most, 0.2}})), std::log(0.5), kNear);
  EXPECT_EQ(term("held", with({{&F::held, 60.0}, {&F::held_most, 50.0}})), 0.0);
  EXPECT_EQ(term("held", with({{&F::held, -5.0}, {&F::held_most, 50.0}})), -3.5);
  EXPECT_NEAR(how_held(with({{&F::held, 0.0}, {&F::held_most, 50.0}})), std::log(0.03), kNear);
  EXPECT_EQ(term("stands out", with({{&F::stands_out, 5.5}})), 5.5);
  EXPECT_EQ(term("stands out", with({{&F::stands_out, 7.0}})), 6.0);
  EXPECT_EQ(term("stands out", with({{&F::stands_out, -1.0}})), 0.0);
}

TEST(VerdictTerms, OfQualityAreWhatTheirFormulasSay) {
  EXPECT_NEAR(term("met locally", with({{&F::walls_met_locally, 0.55}})), -std::log(0.5), kNear);
  EXPECT_EQ(term("met locally", with({{&F::walls_met_locally, 1.0}})), 2.5);
  EXPECT_EQ(term("met locally", with({{&F::walls_met_locally, 0.0}})), 0.0);

  PoseFigures bent = with({{&F::walls_met, 0.6}, {&F::walls_met_locally, 0.8}, {&F::seen_walls, 75.0}});
  EXPECT_NEAR(term("bend explains", bent), 0.5 * std::log(0.45 / 0.25), kNear);
  bent.seen_walls = 400.0;
  EXPECT_NEAR(term("bend explains", bent), std::log(0.45 / 0.25), kNear);
  bent.walls_met = 0.0;
  bent.walls_met_locally = 1.0;
  EXPECT_EQ(term("bend explains", bent), 2.0);

  EXPECT_NEAR(term("cells agree", with({{&F::acceptance_index, 0.95}})), -std::log(0.06), kNear);
  EXPECT_NEAR(term("cells agree", with({{&F::acceptance_index, 1.0}})), -std::log(0.02), kNear);
  EXPECT_EQ(term("cells agree", with({{&F::acceptance_index, 0.5}})), 1.0);

  const PoseFigures things = with({{&F::things_met, 0.9}, {&F::seen_things, 12.0}});
  EXPECT_NEAR(term("things met", things), -std::log(1.05 - (0.9 * 12.0 + 4.0 / 3.0) / 16.0), kNear);
  EXPECT_NEAR(term("things met", {}), -std::log(1.05 - 1.0 / 3.0), kNear);
  EXPECT_EQ(term("things met", with({{&F::things_met, 0.0}, {&F::seen_things, 1e9}})), 0.05);
}

TEST(VerdictTerms, WhatIsExplainedGrowsAsOutliersShrink) {
  EXPECT_NEAR(term("explained", with({{&F::outliers, 0.2}})), -std::log(0.25), kNear);
  EXPECT_EQ(term("explained", with({{&F::outliers, 0.9}})), 0.6);
  EXPECT_EQ(term("explained", with({{&F::outliers, 0.0}})), 2.65);
}

TEST(VerdictTerms, FarAheadGrowsWithTheLeadAndWithTheBend) {
  const auto far_ahead = [](double score_margin, double sigma) {
    return term("far ahead, bent", with({{&F::score_margin, score_margin}, {&F::sigma, sigma}}));
  };
  EXPECT_EQ(far_ahead(50.0, 0.25), 1.0);
  EXPECT_EQ(far_ahead(90.0, 0.9), 1.0);
  EXPECT_NEAR(far_ahead(45.0, 0.25), 0.75, kNear);
  EXPECT_EQ(far_ahead(30.0, 0.25), 0.0);
  EXPECT_NEAR(far_ahead(60.0, 0.15), std::log(1.5) / std::log(2.5), kNear);
  EXPECT_EQ(far_ahead(60.0, 0.1), 0.0);
  EXPECT_EQ(far_ahead(60.0, 0.01), 0.0);
}

TEST(RankTerms, AreWhatTheirFormulasSay) {
  EXPECT_NEAR(rank_term("evidence", with({{&F::score, 600.0}})), std::log(600.0), kNear);
  EXPECT_NEAR(rank_term("evidence", with({{&F::score, 1.2}})), std::log(1.2), kNear);
  EXPECT_EQ(rank_term("evidence", with({{&F::score, -7.0}})), 0.0);
  EXPECT_NEAR(rank_term("uncontradicted", with({{&F::acceptance_index, 0.95}, {&F::common_area, 90.0}})),
              -std::log(0.05 * 90.0 + 0.5), kNear);
  EXPECT_NEAR(rank_term("uncontradicted", with({{&F::acceptance_index, 1.0}, {&F::common_area, 1e6}})),
              -std::log(0.5), kNear);
  EXPECT_NEAR(rank_term("cells", with({{&F::acceptance_index, 1.0}})), -std::log(0.01), kNear);
  EXPECT_NEAR(rank_term("cells", with({{&F::acceptance_index, 0.95}})), -std::log(0.06), kNear);
  EXPECT_NEAR(rank_term("lines", with({{&F::wall_lines, 3.0}})), std::log(3.5), kNear);
  EXPECT_NEAR(rank_term("held", with({{&F::held, 40.0}, {&F::held_most, 50.0}})), std::log(0.8), kNear);
  EXPECT_NEAR(rank_term("things", {}), -std::log(1.05 - 1.0 / 3.0), kNear);
  EXPECT_NEAR(rank_term("tolerance", with({{&F::sigma, 0.04}})), std::log(0.04), kNear);
  EXPECT_NEAR(rank_term("tolerance", with({{&F::sigma, 0.001}})), std::log(0.03), kNear);
}

TEST(ScaledTerms, AreWhatTheirFormulasSay) {
  const VerdictModel model = scaled_model(48);
  const auto scaled_term = [&](const std::string& name, const PoseFigures& figures) {
    return named(model.terms, name)(figures);
  };
  EXPECT_NEAR(scaled_term("tells apart", with({{&F::wall_lines, 3.0}})), std::log(3.5), kNear);
  EXPECT_EQ(scaled_term("tells apart", with({{&F::wall_lines, 0.0}})), 0.0);
  EXPECT_EQ(scaled_term("tells apart", with({{&F::wall_lines, 90.0}})), 3.0);
  EXPECT_NEAR(scaled_term("held", with({{&F::held, 40.0}, {&F::held_most, 50.0}})), std::log(0.8), kNear);
  EXPECT_EQ(scaled_term("held", with({{&F::held, 0.0}, {&F::held_most, 50.0}})), -3.5);
  EXPECT_EQ(scaled_term("stands out", with({{&F::stands_out, 5.5}})), 5.5);
  EXPECT_EQ(scaled_term("stands out", with({{&F::stands_out, 9.0}})), 6.0);
  EXPECT_EQ(scaled_term("stands out", with({{&F::stands_out, -9.0}})), 0.0);
  EXPECT_NEAR(scaled_term("met locally", with({{&F::walls_met_locally, 0.55}})), -std::log(0.5), kNear);
  EXPECT_EQ(scaled_term("met locally", with({{&F::walls_met_locally, 1.0}})), 2.5);
  EXPECT_EQ(scaled_term("met locally", {}), 0.0);

  const auto scaled_rank = [&](const std::string& name, const PoseFigures& figures) {
    return named(model.rank_terms, name).value(figures);
  };
  EXPECT_NEAR(scaled_rank("evidence", with({{&F::score, 1.2}})), std::log(1.2), kNear);
  EXPECT_EQ(scaled_rank("evidence", {}), 0.0);
  EXPECT_NEAR(scaled_rank("seen", with({{&F::seen_walls, 1.2}})), std::log(1.2), kNear);
  EXPECT_EQ(scaled_rank("seen", {}), 0.0);
  EXPECT_NEAR(scaled_rank("lines", with({{&F::wall_lines, 3.0}})), std::log(3.5), kNear);
}

/// Each weighs what the table says, and they add up.
TEST(VerdictModel, SumsItsTermsByTheirWeights) {
  const auto one = [](const PoseFigures&) { return 1.0; };
  const auto two = [](const PoseFigures&) { return 2.0; };
  const std::vector<RankTerm> ranks{{"a", "", one}, {"b", "", two}};
  const std::vector<VerdictTerm> terms{{"c", "", TermKind::amount, 0.0, 9.0, one},
                                       {"d", "", TermKind::quality, 0.0, 1.5, two}};
  const std::vector<VerdictWeight> rank_weights{{"a", 0.5}, {"b", 3.0}}, weights{{"c", 4.0}, {"d", 2.0}};
  const VerdictModel model{ranks, rank_weights, terms, weights, -1.0};
  EXPECT_DOUBLE_EQ(rank_of({}, model), 6.5);
  EXPECT_DOUBLE_EQ(log_odds_of({}, model), 6.0);
}

TEST(CompareRivals, APoseWithoutAnyStandsOutByTwentyNats) {
  std::vector<PoseFigures> alone{with({{&F::score, 0.0}})};
  compare_rivals(alone);
  EXPECT_NEAR(alone[0].stands_out, 20.0, 1e-9);
  EXPECT_EQ(alone[0].score_margin, 0.0);
  alone[0].score = 16.0;
  compare_rivals(alone);
  EXPECT_DOUBLE_EQ(alone[0].score_margin, 4.0);
}

TEST(Slides, WhatIsHeldByLessThanAnEighth) {
  EXPECT_TRUE(slides(with({{&F::held, 13.0}, {&F::held_most, 100.0}})));
  EXPECT_FALSE(slides(with({{&F::held, 14.0}, {&F::held_most, 100.0}})));
}

TEST(IsNearRival, WhoseShareAlonePreventsTheBelief) {
  EXPECT_TRUE(is_near_rival(0.6, 0.04, 0.95));
  EXPECT_FALSE(is_near_rival(0.6, 0.03, 0.95));
  EXPECT_FALSE(is_near_rival(0.75, 0.25, 0.75));
}

}  // namespace
}  // namespace gridmerge
