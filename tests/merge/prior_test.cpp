// SPDX-License-Identifier: Apache-2.0
#include "merge/prior.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace gridmerge {

using namespace internal;
namespace {

const MapExtent kExtent{{5.0, 5.0}, 6.0, 20.0};
const ProblemMap kMap{kExtent};
const KnownPose kOrigin{{}, 0.05, 0.005};
const SE2 kThere{3.0, 1.0, 0.2};
const KnownPose kKnownThere{kThere, 0.05, 0.005};

PairCandidates candidates(const std::vector<SE2>& poses) {
  PairCandidates pair{0, 1, {}};
  for (const SE2& pose : poses) pair.candidates.push_back({pose, -4.0, 0.2});
  return pair;
}

TEST(Prior, WhatIsKnownIsACandidateWhereTheMapsProposeNothing) {
  PairCandidates pair = candidates({{-20.0, 3.0, 1.0}});
  apply_known_poses(kOrigin, kKnownThere, kMap, kMap, pair);
  ASSERT_EQ(pair.candidates.size(), 2u);
  EXPECT_TRUE(pair.candidates[1].is_known);
  EXPECT_EQ(pair.candidates[1].T_fixed_moving, kThere);
  EXPECT_GT(pair.candidates[1].log_odds, 3.0);
  EXPECT_NEAR(pair.candidates[0].log_odds, -4.0, 1e-6) << "a rival, as likely against nothing as before";
}

TEST(Prior, WhatIsKnownMakesTheMapsOwnCandidateThereStrongAndIsNoRivalOfIt) {
  const SE2 nearby = kThere * SE2{0.1, 0.1, 0.01};
  PairCandidates pair = candidates({{-20.0, 3.0, 1.0}, nearby});
  apply_known_poses(kOrigin, kKnownThere, kMap, kMap, pair);
  ASSERT_EQ(pair.candidates.size(), 2u);
  EXPECT_EQ(pair.candidates[1].T_fixed_moving, nearby)
      << "its walls know better than the one who gave the pose";
  EXPECT_GT(pair.candidates[1].log_odds, 3.0);
}

/// Known cells, 9.7 m x 10.3 m, their corner at the origin.
OccupancyGrid known_room() {
  return {97, 103, 0.1, {}, std::vector<Cell>(97 * 103, Cell::free), {}};
}

TEST(Prior, WhatIsKnownIsDoubtedWhereMapsMeetAndProposeNothing) {
  const Coverage coverage(known_room());
  const ProblemMap map{coverage.extent(), &coverage};
  const auto odds_at = [&](double x) {
    PairCandidates pair = candidates({{-20.0, 3.0, 1.0}});
    apply_known_poses(kOrigin, {{x, 0.0, 0.0}, 0.05, 0.005}, map, map, pair);
    EXPECT_EQ(pair.candidates.size(), 2u);
    return pair.candidates[1].log_odds;
  };
  const double apart = odds_at(9.0), a_quarter = odds_at(7.0), a_half = odds_at(4.0);
  EXPECT_GT(apart, a_quarter + 1.0);
  EXPECT_GT(a_quarter, a_half + 1.0);
  EXPECT_LT(a_half, std::log(0.95 / 0.05)) << "not sure enough by itself";

  PairCandidates proposed = candidates({{4.0, 0.3, 0.0}});
  apply_known_poses(kOrigin, {{4.0, 0.0, 0.0}, 0.05, 0.005}, map, map, proposed);
  EXPECT_GT(proposed.candidates[0].log_odds, a_half + 3.0) << "the maps propose it too";
}

TEST(Prior, WhatIsKnownVaguelyIsNoCandidate) {
  PairCandidates pair = candidates({});
  apply_known_poses(kOrigin, {kThere, 30.0, 1.0}, kMap, kMap, pair);
  EXPECT_TRUE(pair.candidates.empty());
}

TEST(Prior, WhatIsKnownVaguelyMakesCandidatesElsewhereLessLikely) {
  PairCandidates pair = candidates({{-20.0, 3.0, 1.0}});
  apply_known_poses(kOrigin, {kThere, 1.0, 0.1}, kMap, kMap, pair);
  ASSERT_EQ(pair.candidates.size(), 1u);
  EXPECT_LT(pair.candidates[0].log_odds, -5.0);
}

TEST(Prior, ACorrectPoseNeverMakesTheMapsOwnCandidateLessSure) {
  // A rival lies so near that a vague pose speaks for it as well: what is left of the whole must not shrink.
  const auto sure = [](const PairCandidates& pair) {
    double sum = 0.0;
    for (const CandidateJoin& candidate : pair.candidates) sum += 1.0 / (1.0 + std::exp(-candidate.log_odds));
    return 1.0 / (1.0 + std::exp(-pair.candidates[0].log_odds)) / std::max(1.0, sum);
  };
  for (const double sd : {0.05, 0.3, 1.0, 3.0}) {
    for (const double own : {-2.0, 1.0, 4.0, 11.5}) {
      PairCandidates pair = candidates({kThere, kThere * SE2{1.5, 0.0, 0.0}, {-20.0, 3.0, 1.0}});
      pair.candidates[0].log_odds = own;
      const double before = sure(pair);
      apply_known_poses({{}, sd, 0.1 * sd}, {kThere, sd, 0.1 * sd}, kMap, kMap, pair);
      EXPECT_GE(sure(pair), before - 1e-6) << "sd " << sd << ", log odds " << own;
    }
  }
}

}  // namespace
}  // namespace gridmerge
