// SPDX-License-Identifier: Apache-2.0
#include "merge/joins.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>
#include <vector>

#include "merge/log_odds.hpp"

namespace gridmerge {

using namespace internal;
namespace {

const SE2 kBest{1.0, 2.0, 0.3};
const SE2 kSecond{-4.0, 0.5, 1.2};

/// What two maps say by themselves, with two hypotheses.
MatchResult said(Verdict verdict, double probability) {
  MatchResult match;
  match.verdict = verdict;
  match.reason = verdict == Verdict::accepted ? Reason::none : Reason::too_little_overlap;
  match.T_fixed_moving = kBest;
  match.probability = probability;
  match.acceptance_index = 0.9;
  match.agreement = 90;
  match.disagreement = 10;
  match.overlap = 0.25;
  match.hypotheses = {{kBest, 10.0, probability}, {kSecond, 5.0, 0.01}};
  return match;
}

Join join_in(Verdict verdict, const CandidateJoin* used, bool is_placed) {
  return make_join(2, 5, said(verdict, 0.9), {used, is_placed});
}

TEST(MakeJoin, AloneMeansWhatItsOwnVerdictSays) {
  const Join join = make_join(2, 5, said(Verdict::accepted, 0.97));
  EXPECT_EQ(join.fixed, 2U);
  EXPECT_EQ(join.moving, 5U);
  EXPECT_EQ(join.outcome, JoinOutcome::accepted);
  EXPECT_EQ(join.T_fixed_moving, kBest);
  EXPECT_EQ(join.probability, 0.97);
  EXPECT_EQ(join.acceptance_index, 0.9);
  EXPECT_EQ(join.agreement, 90);
  EXPECT_EQ(join.disagreement, 10);
  EXPECT_EQ(join.overlap, 0.25);
  EXPECT_EQ(make_join(0, 1, said(Verdict::refused, 0.5)).outcome, JoinOutcome::refused);
}

TEST(MakeJoin, OfABelievedPairFollowsWhatTheOthersMakeOfIt) {
  const CandidateJoin best{kBest, 3.0, 0.1}, second{kSecond, -3.0, 0.1};
  const Join accepted = join_in(Verdict::accepted, &best, true);
  EXPECT_EQ(accepted.outcome, JoinOutcome::accepted);
  EXPECT_EQ(accepted.probability, 0.9);
  EXPECT_EQ(accepted.reason(), Reason::none);
  const Join elsewhere = join_in(Verdict::accepted, &second, true);
  EXPECT_EQ(elsewhere.outcome, JoinOutcome::rescued);
  EXPECT_EQ(elsewhere.T_fixed_moving, kSecond);
  EXPECT_EQ(elsewhere.probability, 0.01);
  const Join rejected = join_in(Verdict::accepted, nullptr, true);
  EXPECT_EQ(rejected.outcome, JoinOutcome::rejected);
  EXPECT_EQ(rejected.reason(), Reason::contradicts_others);
  EXPECT_EQ(rejected.T_fixed_moving, kBest);
  const Join unused = join_in(Verdict::accepted, nullptr, false);
  EXPECT_EQ(unused.outcome, JoinOutcome::refused);
  EXPECT_EQ(unused.reason(), Reason::ambiguous);
}

TEST(MakeJoin, OfAWeakPairIsRescuedOrRefused) {
  const CandidateJoin best{kBest, 0.0, 0.1};
  EXPECT_EQ(join_in(Verdict::refused, &best, true).outcome, JoinOutcome::rescued);
  for (const bool is_placed : {false, true}) {
    const Join refused = join_in(Verdict::refused, nullptr, is_placed);
    EXPECT_EQ(refused.outcome, JoinOutcome::refused);
    EXPECT_EQ(refused.reason(), Reason::too_little_overlap);
    EXPECT_EQ(refused.verdict(), Verdict::refused);
  }
}

TEST(MakeJoin, OfPosesThatAreKnownSaysNothingOfTheMaps) {
  const CandidateJoin known{kSecond, 9.0, 0.1, true};
  for (const Verdict verdict : {Verdict::accepted, Verdict::refused}) {
    const Join join = join_in(verdict, &known, true);
    EXPECT_EQ(join.outcome, JoinOutcome::known);
    EXPECT_EQ(join.T_fixed_moving, kSecond);
    EXPECT_EQ(join.probability, 0.0);
    EXPECT_TRUE(join.used());
  }
}

TEST(MakeJoin, InvertedIsOfTheOtherMap) {
  const CandidateJoin second{kSecond, 0.0, 0.1};
  const Join join = inverted(join_in(Verdict::accepted, &second, true));
  EXPECT_EQ(join.fixed, 5U);
  EXPECT_EQ(join.moving, 2U);
  EXPECT_EQ(join.T_fixed_moving, inverse(kSecond));
  EXPECT_EQ(join.match.T_fixed_moving, inverse(kBest));
}

TEST(JoinOutcome, HasAWordOfItsOwn) {
  EXPECT_STREQ(name_of(JoinOutcome::accepted), "accepted");
  EXPECT_STREQ(name_of(JoinOutcome::rescued), "rescued");
  EXPECT_STREQ(name_of(JoinOutcome::rejected), "rejected");
  EXPECT_STREQ(name_of(JoinOutcome::known), "known");
  EXPECT_STREQ(name_of(JoinOutcome::refused), "refused");
}

TEST(WhyLeftOut, IsTheReasonOfTheMostProbableJoinOfThatMap) {
  const auto join = [](std::size_t fixed, std::size_t moving, double probability, Reason reason) {
    Join made = make_join(fixed, moving, said(Verdict::refused, probability));
    made.match.reason = reason;
    return made;
  };
  const std::vector<Join> joins{join(0, 1, 0.2, Reason::ambiguous), join(1, 2, 0.4, Reason::contradiction),
                                join(0, 3, 0.9, Reason::several),
                                join(1, 4, 0.3, Reason::too_little_overlap)};
  EXPECT_EQ(left_out(1, joins), (LeftOut{1, Reason::contradiction}));
  EXPECT_EQ(left_out(0, joins), (LeftOut{0, Reason::several}));
  EXPECT_EQ(left_out(4, joins), (LeftOut{4, Reason::too_little_overlap}));
  EXPECT_EQ(left_out(7, joins), (LeftOut{7, Reason::nothing_to_compare}));
}

TEST(FinestResolution, IsTheLeast) {
  const OccupancyGrid coarse = make_grid(2, 2, 0.2), fine = make_grid(2, 2, 0.05),
                      middle = make_grid(2, 2, 0.1);
  EXPECT_EQ(finest_resolution({{&coarse, {}}, {&fine, {}}, {&middle, {}}}), 0.05);
}

TEST(FittingResolution, IsCoarserWhereTheMapsWouldNotFit) {
  const OccupancyGrid map = make_grid(1500, 1500, 0.001, {}, Cell::free);  // 2^28 cells are 60 per cell
  const auto fits = [&](double far) {
    return fitting_resolution(0.05, {{&map, {}}, {&map, {far, far, 0.4}}});
  };
  EXPECT_EQ(fits(500.0), 0.05);
  EXPECT_EQ(fits(1500.0), 0.1);
  for (const double far : {700.0, 815.0, 818.0, 822.0, 4000.0, 1e7}) {
    const std::vector<PlacedMap> maps{{&map, {}}, {&map, {far, far, 0.4}}};
    const double resolution = fits(far);
    EXPECT_NO_THROW(cover(maps, resolution)) << far;  // fits, and none that is much finer does
    EXPECT_TRUE(resolution == 0.05 || far / (0.5 * resolution) > 16000.0) << far;
  }
  EXPECT_EQ(fits(1e9), kMaxResolution) << "and then it is refused";
  const OccupancyGrid unknown = make_grid(2, 2, 0.2);
  EXPECT_EQ(fitting_resolution(0.3, {{&unknown, {}}}), 0.3);
}

TEST(FittingResolution, GivesAFewCellsNoRoomOfMillions) {
  // Two squares of known cells, `far` apart along both axes, in grids with such a border of unknown ones.
  const auto cells = [](int side, double far, int border = 0) {
    OccupancyGrid map =
        make_grid(side + 2 * border, side + 2 * border, 0.01, {-0.01 * border, -0.01 * border, 0.0});
    for (int row = border; row < border + side; ++row) {
      for (int column = border; column < border + side; ++column) map.at(column, row) = Cell::free;
    }
    const std::vector<PlacedMap> maps{{&map, {}}, {&map, {far, far, 0.0}}};
    const Lattice lattice = cover(maps, fitting_resolution(0.01, maps));
    return static_cast<double>(lattice.width) * lattice.height;
  };
  // Four million are few; where more would be needed, the next coarser power of two will do.
  const double few = 1 << 22;
  EXPECT_NEAR(cells(40, 20.0), 2040.0 * 2040.0, 1e4);
  for (const double far : {21.0, 40.0, 100.0}) {
    EXPECT_LE(cells(40, far), few) << far;
    EXPECT_GT(cells(40, far), few / 4.2) << far;
  }
  // Of larger maps there are 64 per known cell. Borders count for nothing.
  const double most = 64.0 * 2.0 * 400.0 * 400.0;
  for (const int border : {0, 300}) {
    EXPECT_NEAR(cells(400, 41.0, border), 4500.0 * 4500.0, 1e5) << border;
    EXPECT_LE(cells(400, 43.0, border), most) << border;
    EXPECT_GT(cells(400, 43.0, border), most / 4.2) << border;
  }
}

TEST(MergedResolution, IsTheOneAskedForOrTheFinest) {
  const OccupancyGrid coarse = make_grid(2, 2, 0.2), fine = make_grid(2, 2, 0.05);
  EXPECT_EQ(merged_resolution(0.3, {{&coarse, {}}, {&fine, {}}}), 0.3);
  EXPECT_EQ(merged_resolution(0.0, {{&coarse, {}}, {&fine, {}}}), 0.05);
  // As coarse as it takes, unless it was asked for.
  const OccupancyGrid known = make_grid(2, 2, 0.05, {}, Cell::free);
  const std::vector<PlacedMap> far{{&known, {}}, {&known, {2000.0, 2000.0, 0.0}}};
  EXPECT_EQ(merged_resolution(0.0, far), 0.2);
  EXPECT_EQ(merged_resolution(0.05, far), 0.05);
  EXPECT_EQ(merged_resolution(0.0, {{&known, {}}, {&known, {1e6, 1e6, 0.0}}}), 0.8)
      << "and then it is refused";
  // Coarser than any map it is never.
  const OccupancyGrid coarsest = make_grid(2, 2, kMaxResolution, {}, Cell::free);
  EXPECT_EQ(merged_resolution(0.0, {{&coarsest, {}}, {&coarsest, {1e8, 1e8, 0.0}}}), kMaxResolution);
}

TEST(ValidateMerge, RefusesResolutionsThatMakeNoSense) {
  EXPECT_NO_THROW(validate_merge({}, 0.0));
  EXPECT_NO_THROW(validate_merge({make_grid(1, 1, 0.1)}, 0.3));
  EXPECT_NO_THROW(validate_merge({}, kMinResolution));
  EXPECT_NO_THROW(validate_merge({}, kMaxResolution));
  for (const double resolution :
       {-0.1, 0.5 * kMinResolution, 1.01 * kMaxResolution, std::nan(""), HUGE_VAL, -HUGE_VAL})
    EXPECT_THROW(validate_merge({}, resolution), std::invalid_argument) << resolution;
}

}  // namespace
}  // namespace gridmerge
