// SPDX-License-Identifier: Apache-2.0
#include "match/verdict.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <set>
#include <string>
#include <vector>

#include "match/verdict_model.hpp"

namespace gridmerge {

using namespace internal;
namespace {

/// Two clean maps of one place that share half a floor.
PoseFigures clear_pose() {
  PoseFigures figures;
  figures.score = 6000.0;
  figures.score_margin = 40.0;
  figures.stands_out = 20.0;
  figures.wall_score = 5800.0;
  figures.seen_walls = 240.0;
  figures.walls_met = 0.93;
  figures.walls_met_locally = 0.95;
  figures.wall_lines = 12.0;
  figures.seen_things = 40.0;
  figures.things_met = 0.9;
  figures.spread = 5.0;
  figures.held = 4000.0;
  figures.held_most = 5000.0;
  figures.acceptance_index = 0.985;
  figures.common_area = 300.0;
  figures.overlap = 0.6;
  figures.sigma = 0.07;
  figures.outliers = 0.1;
  return figures;
}

double alone(const PoseFigures& figures) {
  return probabilities_of(std::vector{figures}).front();
}

PoseFigures changed(double PoseFigures::*figure, double value) {
  PoseFigures figures = clear_pose();
  figures.*figure = value;
  return figures;
}

/// Both were found between two maps of one simulated office that share a tenth of its floor.
TEST(RankOf, ATruePoseThatOverlapsLittleStandsBeforeAWrongOneThatContradictsItself) {
  PoseFigures little, much;
  little.score = 1057.0;
  little.acceptance_index = 0.968;
  little.common_area = 13.2;
  little.wall_lines = 2.96;
  little.seen_things = 7.1;
  little.things_met = 0.75;
  little.held = 1230.0;
  little.held_most = 1620.0;
  little.sigma = 0.05;
  much.score = 3327.0;
  much.acceptance_index = 0.947;
  much.common_area = 89.6;
  much.wall_lines = 7.1;
  much.seen_things = 82.8;
  much.things_met = 0.49;
  much.held = 1790.0;
  much.held_most = 4660.0;
  much.sigma = 0.035;
  EXPECT_GT(rank_of(little), rank_of(much));
  // What contradicts decides between them: with as little of it the larger one is better.
  much.acceptance_index = 0.995;
  EXPECT_LT(rank_of(little), rank_of(much));
}

/// The probabilities of poses that are each other's only rivals.
std::vector<double> among_each_other(std::vector<PoseFigures> poses) {
  compare_rivals(poses);
  return probabilities_of(poses);
}

TEST(PoseFigures, EachHasANameAUnitAMeaningAndAPlaceOfItsOwn) {
  std::set<std::string> names;
  PoseFigures figures;
  double next = 1.0;
  for (const PoseFigure& figure : pose_figures()) {
    EXPECT_TRUE(names.insert(figure.name).second) << figure.name;
    EXPECT_STRNE(figure.unit, "");
    EXPECT_STRNE(figure.meaning, "");
    EXPECT_EQ(figures.*figure.value, 0.0) << figure.name;  // no other one has it
    figures.*figure.value = next++;
  }
  // As many as there are members, all of them numbers.
  EXPECT_EQ(pose_figures().size() * sizeof(double), sizeof(PoseFigures));
}

/// docs/verdict.md says of the model what the tables in the code say.
TEST(VerdictTables, AreThoseOfTheDocs) {
  std::ifstream file("docs/verdict.md");
  const std::string docs((std::istreambuf_iterator<char>(file)), {});
  ASSERT_FALSE(docs.empty());
  const auto expect_row = [&](const std::string& row) {
    EXPECT_NE(docs.find(row), std::string::npos) << "docs/verdict.md lacks\n" << row;
  };
  for (const PoseFigure& figure : pose_figures()) {
    const std::string unit = *figure.unit == '\0' ? "" : figure.unit;
    expect_row("| `" + std::string(figure.name) + "` | " + unit + " | " + figure.meaning + " |\n");
  }
  ASSERT_EQ(kVerdictWeights.size(), verdict_terms().size());
  for (std::size_t i = 0; i < kVerdictWeights.size(); ++i) {
    const VerdictTerm& term = verdict_terms()[i];
    EXPECT_STREQ(term.name, kVerdictWeights[i].term);
    char weight[32];
    std::snprintf(weight, sizeof weight, "%.2f", kVerdictWeights[i].weight);
    expect_row("| " + std::string(term.name) + " | `" + term.formula + "` | " + name_of(term.kind) + " | " +
               weight + " |\n");
  }
  ASSERT_EQ(kRankWeights.size(), rank_terms().size());
  for (std::size_t i = 0; i < kRankWeights.size(); ++i) {
    const RankTerm& term = rank_terms()[i];
    EXPECT_STREQ(term.name, kRankWeights[i].term);
    char weight[32];
    std::snprintf(weight, sizeof weight, "%.2f", kRankWeights[i].weight);
    expect_row("| " + std::string(term.name) + " | `" + term.formula + "` | " + weight + " |\n");
  }
}

TEST(VerdictTerms, StayWithinTheirBoundsWhateverTheFigures) {
  for (const double value : {0.0, 1.0, -1.0, 1e12, -1e12}) {
    PoseFigures figures;
    for (const PoseFigure& figure : pose_figures()) figures.*figure.value = value;
    for (const VerdictTerm& term : verdict_terms()) {
      EXPECT_GE(term(figures), term.least) << term.name << ' ' << value;
      EXPECT_LE(term(figures), term.most) << term.name << ' ' << value;
    }
  }
}

TEST(ProbabilitiesOf, AClearPoseIsBelievedAndNothingIsNot) {
  EXPECT_GT(alone(clear_pose()), 0.98);
  EXPECT_LT(alone({}), 1e-4);
  EXPECT_TRUE(probabilities_of({}).empty());
}

TEST(ProbabilitiesOf, RiseWithWhatSpeaksForThePose) {
  const double usual = log_odds_of(clear_pose());
  EXPECT_LT(log_odds_of(changed(&PoseFigures::wall_lines, 4.0)), usual);
  EXPECT_LT(log_odds_of(changed(&PoseFigures::walls_met_locally, 0.7)), usual);
  EXPECT_LT(log_odds_of(changed(&PoseFigures::acceptance_index, 0.93)), usual);
  EXPECT_LT(log_odds_of(changed(&PoseFigures::things_met, 0.3)), usual);
  EXPECT_LT(log_odds_of(changed(&PoseFigures::held, 100.0)), usual);
}

/// Two walls and a corner, which fit another corner as well.
PoseFigures corner_pose() {
  PoseFigures corner = changed(&PoseFigures::wall_lines, 2.0);
  corner.seen_walls = 8.0;
  corner.score_margin = 5.0;
  corner.stands_out = 1.0;  // other corners are nearly as good
  corner.seen_things = 0.0;
  return corner;
}

TEST(ProbabilitiesOf, ACornerTellsNoPlacesApart) {
  EXPECT_LT(alone(corner_pose()), 0.01);
}

TEST(ProbabilitiesOf, ALeadSpeaksForBentMapsOnly) {
  PoseFigures bent = clear_pose();
  bent.walls_met = 0.5;
  bent.walls_met_locally = 0.75;
  bent.things_met = 0.5;
  bent.acceptance_index = 0.94;
  bent.score_margin = 50.0;
  bent.stands_out = 4.0;
  bent.outliers = 0.5;
  bent.sigma = 0.25;
  EXPECT_GT(alone(bent), 0.95);
  PoseFigures crisp = bent;
  crisp.sigma = 0.05;  // the walls that do meet lie on each other: so should the others
  EXPECT_LT(alone(crisp), 0.95);
  PoseFigures bent_without_margin = bent;
  bent_without_margin.score_margin = 15.0;  // unrelated maps have as much
  EXPECT_LT(alone(bent_without_margin), 0.95);
}

TEST(ProbabilitiesOf, ABendExplainsLittleOfFewWalls) {
  // That patches meet better when they may shift speaks for a pose, as far as there are many walls.
  const auto gain = [](double seen_walls) {
    PoseFigures rigid = clear_pose();
    rigid.seen_walls = seen_walls;
    rigid.walls_met = rigid.walls_met_locally = 0.8;
    PoseFigures bent = rigid;
    bent.walls_met = 0.6;
    return log_odds_of(bent) - log_odds_of(rigid);
  };
  EXPECT_GT(gain(300.0), 0.0);
  EXPECT_DOUBLE_EQ(gain(150.0), gain(1000.0));
  EXPECT_NEAR(gain(50.0), gain(150.0) / 3.0, 1e-9);
  EXPECT_NEAR(gain(0.0), 0.0, 1e-9);
}

TEST(ProbabilitiesOf, MoreThanNearlyAllCellsTellsNothing) {
  EXPECT_EQ(log_odds_of(changed(&PoseFigures::acceptance_index, 0.991)),
            log_odds_of(changed(&PoseFigures::acceptance_index, 1.0)));
}

TEST(CompareRivals, GivesEachItsLeadOverTheBestOther) {
  std::vector<PoseFigures> poses(3);
  for (int i = 0; i < 3; ++i) poses[i].score = 100.0 * (i + 1);
  compare_rivals(poses);
  EXPECT_DOUBLE_EQ(poses[2].score_margin, 100.0 / std::sqrt(300.0));
  EXPECT_DOUBLE_EQ(poses[0].score_margin, -200.0 / std::sqrt(100.0));
  // A lower maximum beside a pose is no rival of it, but it has the pose for one.
  const auto last_two = [](std::size_t a, std::size_t b) { return a + b == 3; };
  compare_rivals(poses, last_two);
  EXPECT_DOUBLE_EQ(poses[2].score_margin, 200.0 / std::sqrt(300.0));
  EXPECT_DOUBLE_EQ(poses[1].score_margin, -100.0 / std::sqrt(200.0));
}

TEST(ProbabilitiesOf, ThingsCountByHowManyThereAre) {
  PoseFigures few = clear_pose(), many = clear_pose();
  few.seen_things = 0.5;
  few.things_met = many.things_met = 0.0;
  EXPECT_GT(log_odds_of(few), log_odds_of(many));
  few.things_met = many.things_met = 1.0;
  EXPECT_LT(log_odds_of(few), log_odds_of(many));
}

TEST(ProbabilitiesOf, EqualRivalsShareWhatThereIs) {
  const std::vector<double> two = among_each_other({clear_pose(), clear_pose()});
  EXPECT_NEAR(two[0], two[1], 1e-6);
  EXPECT_LT(two[0], 0.5);
  EXPECT_GT(two[0], 0.3);
}

TEST(ProbabilitiesOf, PoorRivalsTakeNothingAway) {
  std::vector<PoseFigures> poses(12);
  poses.front() = clear_pose();
  EXPECT_NEAR(among_each_other(poses).front(), alone(clear_pose()), 1e-3);
}

TEST(ProbabilitiesOf, QualityStandsBeforeAmount) {
  PoseFigures little = clear_pose(), much = clear_pose();
  little.score = 900.0;
  little.seen_walls = 40.0;
  little.wall_lines = 5.0;
  much.score = 1500.0;
  much.seen_walls = 300.0;
  much.walls_met_locally = 0.6;
  much.acceptance_index = 0.9;
  much.things_met = 0.4;
  const std::vector<double> both = among_each_other({much, little});
  EXPECT_GT(both[1], 100.0 * both[0]);
}

TEST(CompareRivals, ANearLowerMaximumLeavesAPoseStandingOut) {
  std::vector<PoseFigures> poses{clear_pose(), clear_pose()};
  poses[1].score = 5900.0;
  compare_rivals(poses);
  EXPECT_LT(poses[0].stands_out, 1.0);
  compare_rivals(poses, [](std::size_t, std::size_t) { return true; });
  EXPECT_GT(poses[0].stands_out, 10.0);
  EXPECT_LT(poses[1].stands_out, 0.0);
  const std::vector<double> probabilities = probabilities_of(poses);
  EXPECT_NEAR(probabilities[0], alone(clear_pose()), 1e-5);
  EXPECT_LT(probabilities[1], 1e-6);
}

RC_GTEST_PROP(ProbabilitiesOf, AddUpToTheBeliefInTheBestAndFollowTheRanks, ()) {
  std::vector<PoseFigures> poses(*rc::gen::inRange<std::size_t>(1, 8));
  for (PoseFigures& pose : poses) {
    pose = clear_pose();
    pose.score = *rc::gen::inRange(1, 8000);
    pose.wall_lines = *rc::gen::inRange(0, 40) / 2.0;
    pose.walls_met_locally = *rc::gen::inRange(0, 100) / 100.0;
    pose.acceptance_index = *rc::gen::inRange(0, 1000) / 1000.0;
  }
  compare_rivals(poses);
  const std::vector<double> probabilities = probabilities_of(poses);
  double sum = 0.0;
  std::size_t best = 0;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    RC_ASSERT(probabilities[i] >= 0.0 && probabilities[i] <= 1.0);
    sum += probabilities[i];
    if (rank_of(poses[i]) > rank_of(poses[best])) best = i;
  }
  for (std::size_t i = 0; i < poses.size(); ++i) RC_ASSERT(probabilities[i] <= probabilities[best] + 1e-12);
  const double belief = 1.0 / (1.0 + std::exp(-log_odds_of(poses[best])));
  RC_ASSERT(sum <= belief * (1.0 + 1e-9));
  if (poses.size() > 1) RC_ASSERT(std::abs(sum - belief) < 1e-6 * belief + 1e-12);
}

TEST(ExplainRefusal, NamesWhatHoldsThePairBack) {
  constexpr double kAccept = 0.95;
  const auto reason = [](const std::vector<PoseFigures>& poses) { return explain_refusal(poses, kAccept); };
  EXPECT_EQ(reason({}), Reason::nothing_to_compare);
  EXPECT_EQ(reason({clear_pose()}), Reason::none);
  const auto reason_among = [&](std::vector<PoseFigures> poses) {
    compare_rivals(poses);
    return reason(poses);
  };
  EXPECT_EQ(reason_among({clear_pose(), clear_pose()}), Reason::ambiguous);

  PoseFigures contradicting = clear_pose();
  contradicting.walls_met = contradicting.walls_met_locally = 0.45;
  contradicting.acceptance_index = 0.88;
  contradicting.things_met = 0.1;
  contradicting.score_margin = 8.0;
  EXPECT_EQ(reason({contradicting}), Reason::contradiction);

  const PoseFigures corner = corner_pose();
  EXPECT_EQ(reason({corner}), Reason::too_little_overlap);
  // Two ways to lay a room on itself: not too little, whatever their number of lines.
  EXPECT_EQ(reason_among({corner, corner}), Reason::ambiguous);

  PoseFigures hopeless = contradicting;
  hopeless.wall_lines = 1.0;
  hopeless.seen_walls = 8.0;
  EXPECT_EQ(reason({hopeless}), Reason::several);
  EXPECT_STREQ(name_of(Reason::ambiguous), "ambiguous");
  EXPECT_STREQ(name_of(Reason::too_little_overlap), "too_little_overlap");
}

TEST(ExplainRefusal, MapsThatSlideAreAmbiguous) {
  PoseFigures corridor = changed(&PoseFigures::wall_lines, 3.0);
  corridor.held = 0.0;
  corridor.score_margin = 2.0;
  corridor.stands_out = 1.0;
  EXPECT_EQ(explain_refusal(std::vector{corridor}, 0.95), Reason::ambiguous);
}

}  // namespace
}  // namespace gridmerge
