// SPDX-License-Identifier: Apache-2.0
#include "preselect/chance.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "grid/logistic.hpp"

namespace gridmerge::internal {
namespace {

/// Log-odds as a model that is right for a share of 0.0024 would give them, of a set with another share.
std::vector<float> drawn(std::size_t joined, std::size_t unrelated) {
  std::mt19937 random(7);
  // Two normal distributions of one width: their log-likelihood ratio is linear.
  const double apart = 4.0;
  std::normal_distribution<double> normal;
  std::vector<float> log_odds;
  const auto add = [&](double mean) {
    const double x = mean + normal(random);
    log_odds.push_back(
        static_cast<float>(apart * x - apart * apart / 2.0 + std::log(0.002372 / (1.0 - 0.002372))));
  };
  for (std::size_t i = 0; i < joined; ++i) add(apart);
  for (std::size_t i = 0; i < unrelated; ++i) add(0.0);
  return log_odds;
}

TEST(Chance, ProbabilitiesFitASetInWhichJoinsAreRarerOrMoreCommon) {
  for (const std::size_t unrelated : {500, 5000, 200000}) {
    const std::vector<float> log_odds = drawn(100, unrelated);
    const double shift = shift_to_this_set(log_odds);
    double expected = 0.0;
    for (const float one : log_odds) expected += logistic(one + shift);
    EXPECT_NEAR(expected, 100.0, 15.0) << unrelated;
  }
}

TEST(Chance, NoPairsNeedNoShift) {
  EXPECT_EQ(shift_to_this_set({}), 0.0);
}

TEST(Chance, ASetWithoutJoinsExpectsNone) {
  const std::vector<float> log_odds = drawn(0, 5000);
  const double shift = shift_to_this_set(log_odds);
  double expected = 0.0;
  for (const float one : log_odds) expected += logistic(one + shift);
  EXPECT_LT(expected, 3.0);
  EXPECT_TRUE(std::isfinite(shift));
}

TEST(Chance, MoreWallsThatMeetAreMoreLikelyOfOnePlace) {
  Signature map;
  map.wall_length = 100.0;
  SignatureMatch match;
  match.seen = 60.0;
  match.chance = 8.0;
  double last = -1e9;
  for (double met = 0.0; met <= 60.0; met += 10.0) {
    match.met = met;
    const double next = log_odds_of_joining(match, map, map);
    EXPECT_GT(next, last);
    last = next;
  }
  match.votes = 5.0;
  EXPECT_GT(log_odds_of_joining(match, map, map), last);
}

SignatureMatch match_of(double seen, double met, double open, double chance, double votes, double next_votes,
                        double likeness) {
  SignatureMatch match;
  match.seen = seen;
  match.met = met;
  match.open = open;
  match.chance = chance;
  match.votes = votes;
  match.next_votes = next_votes;
  match.likeness = likeness;
  return match;
}

/// A pair as half of them look, more or less.
SignatureMatch usual_match() {
  return match_of(60.0, 30.0, 10.0, 8.0, 4.0, 1.0, 0.6);
}

TEST(Chance, EachFigureSpeaksForOrAgainst) {
  Signature map, larger;
  map.wall_length = 100.0;
  larger.wall_length = 300.0;
  const auto gain = [&](double SignatureMatch::*figure, double more) {
    SignatureMatch match = usual_match();
    match.*figure += more;
    return log_odds_of_joining(match, map, map) - log_odds_of_joining(usual_match(), map, map);
  };
  EXPECT_GT(gain(&SignatureMatch::met, 5.0), 0.1);
  EXPECT_LT(gain(&SignatureMatch::chance, 5.0), -0.1);
  EXPECT_LE(gain(&SignatureMatch::open, 5.0), 0.0);
  EXPECT_GT(gain(&SignatureMatch::votes, 2.0), 0.1);
  EXPECT_LT(gain(&SignatureMatch::next_votes, 2.0), -0.1);
  EXPECT_GT(gain(&SignatureMatch::likeness, 0.3), 0.05);
  // The smaller map counts, whichever of the two it is.
  EXPECT_EQ(log_odds_of_joining(usual_match(), map, larger), log_odds_of_joining(usual_match(), larger, map));
  EXPECT_EQ(log_odds_of_joining(usual_match(), map, larger), log_odds_of_joining(usual_match(), map, map));
  EXPECT_NE(log_odds_of_joining(usual_match(), map, larger),
            log_odds_of_joining(usual_match(), larger, larger));
}

TEST(Chance, MediansOfJoinsAndOfStrangersAreFarApart) {
  // Medians over a campus of 80 simulated maps to which nothing was fitted (benchmark/fleet.py --campus
  // reported).
  Signature map;
  const SignatureMatch joined = match_of(109.0, 79.0, 4.5, 17.2, 3.7, 2.0, 0.78);
  const SignatureMatch strangers = match_of(62.6, 27.7, 8.7, 8.5, 0.86, 1.14, 0.55);
  map.wall_length = 177.0;
  const double of_joined = log_odds_of_joining(joined, map, map);
  map.wall_length = 105.0;
  const double of_strangers = log_odds_of_joining(strangers, map, map);
  // Two or three in a thousand pairs are joined: log-odds of -6. The former are likelier than that, by far.
  EXPECT_GT(of_joined, -2.0);
  EXPECT_LT(of_joined, 1.0);
  EXPECT_LT(of_strangers, -9.0);
  EXPECT_GT(of_strangers, -12.0);
}

TEST(Chance, TheShiftIsTheOneOfTheShareThatItImplies) {
  // Log-odds of the mean probability differ from the shift by the same amount in each set: those of the fit.
  std::vector<double> fitted;
  for (const std::size_t unrelated : {300, 3000, 30000}) {
    const std::vector<float> log_odds = drawn(100, unrelated);
    const double shift = shift_to_this_set(log_odds);
    double mean = 0.0;
    for (const float one : log_odds) mean += logistic(one + shift) / static_cast<double>(log_odds.size());
    fitted.push_back(std::log(mean / (1.0 - mean)) - shift);
  }
  EXPECT_NEAR(fitted[0], fitted[1], 1e-4);
  EXPECT_NEAR(fitted[0], fitted[2], 1e-4);
  // A few in a thousand pairs are joined in the sets of the fit.
  EXPECT_LT(fitted[0], std::log(0.01));
  EXPECT_GT(fitted[0], std::log(0.001));
}

TEST(Chance, AShareIsNeverNothingAndNeverAll) {
  // However the pairs look, a tenth of one may be joined, and a tenth of all may not.
  const auto mean_of = [](const std::vector<float>& log_odds) {
    const double shift = shift_to_this_set(log_odds);
    return logistic(shift + std::log(0.002372 / (1.0 - 0.002372)));
  };
  EXPECT_NEAR(mean_of(std::vector<float>(100, -40.0F)), 0.001, 1e-6);
  EXPECT_NEAR(mean_of(std::vector<float>(100, 40.0F)), 0.9, 1e-6);
}

TEST(Chance, AFirstLookThatThinksMorePromisesMore) {
  EXPECT_GT(log_odds_after_a_look(0.0, 0.9), log_odds_after_a_look(0.0, 0.1));
  EXPECT_GT(log_odds_after_a_look(2.0, 0.1), log_odds_after_a_look(-2.0, 0.1));
  EXPECT_TRUE(std::isfinite(log_odds_after_a_look(0.0, 0.0)));
  EXPECT_TRUE(std::isfinite(log_odds_after_a_look(0.0, 1.0)));
}

TEST(Chance, AFirstLookIsNeverSure) {
  EXPECT_EQ(log_odds_after_a_look(0.5, 0.0), log_odds_after_a_look(0.5, 1e-4));
  EXPECT_EQ(log_odds_after_a_look(0.5, 1.0), log_odds_after_a_look(0.5, 0.999));
  EXPECT_LT(log_odds_after_a_look(0.5, 1e-4), log_odds_after_a_look(0.5, 1.1e-4));
  EXPECT_LT(log_odds_after_a_look(0.5, 0.9985), log_odds_after_a_look(0.5, 0.999));
  // It is linear in the log-odds of either.
  const auto of_both = [](double signature, double match) {
    return log_odds_after_a_look(signature, logistic(match));
  };
  const double base = of_both(0.0, 0.0);
  EXPECT_NEAR(of_both(3.0, -2.0) - base, 3.0 * (of_both(1.0, 0.0) - base) - 2.0 * (of_both(0.0, 1.0) - base),
              1e-9);
}

TEST(Chance, OfNothingSeenOrTooLittleWallIsFinite) {
  const Signature nothing;
  const SignatureMatch none;
  EXPECT_TRUE(std::isfinite(log_odds_of_joining(none, nothing, nothing)));
  // What was seen is weighed against the smaller map's walls: the same of a small map says more.
  Signature small, large;
  small.wall_length = 70.0;
  large.wall_length = 700.0;
  const SignatureMatch match = usual_match();
  EXPECT_NE(log_odds_of_joining(match, small, large), log_odds_of_joining(match, large, large));
}

}  // namespace
}  // namespace gridmerge::internal
