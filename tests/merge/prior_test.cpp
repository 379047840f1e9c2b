// SPDX-License-Identifier: Apache-2.0
#include "merge/prior.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace gridmerge {

using namespace internal;
namespace {

const MapExtent kExtent{{5.0, 5.0}, 6.0, 20.0};
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
  apply_known_poses(kOrigin, kKnownThere, kExtent, kExtent, pair);
  ASSERT_EQ(pair.candidates.size(), 2u);
  EXPECT_TRUE(pair.candidates[1].is_known);
  EXPECT_EQ(pair.candidates[1].T_fixed_moving, kThere);
  EXPECT_GT(pair.candidates[1].log_odds, 3.0);
  EXPECT_LT(pair.candidates[0].log_odds, -4.0) << "it lies elsewhere";
}

TEST(Prior, WhatIsKnownMakesTheMapsOwnCandidateThereStrongAndIsNoRivalOfIt) {
  const SE2 nearby = kThere * SE2{0.1, 0.1, 0.01};
  PairCandidates pair = candidates({{-20.0, 3.0, 1.0}, nearby});
  apply_known_poses(kOrigin, kKnownThere, kExtent, kExtent, pair);
  ASSERT_EQ(pair.candidates.size(), 2u);
  EXPECT_EQ(pair.candidates[1].T_fixed_moving, nearby)
      << "its walls know better than the one who gave the pose";
  EXPECT_GT(pair.candidates[1].log_odds, 3.0);
}

TEST(Prior, WhatIsKnownVaguelyIsNoCandidate) {
  PairCandidates pair = candidates({});
  apply_known_poses(kOrigin, {kThere, 30.0, 1.0}, kExtent, kExtent, pair);
  EXPECT_TRUE(pair.candidates.empty());
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
      apply_known_poses({{}, sd, 0.1 * sd}, {kThere, sd, 0.1 * sd}, kExtent, kExtent, pair);
      EXPECT_GE(sure(pair), before - 1e-6) << "sd " << sd << ", log odds " << own;
    }
  }
}

}  // namespace
}  // namespace gridmerge
