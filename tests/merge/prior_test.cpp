// SPDX-License-Identifier: Apache-2.0
#include "merge/prior.hpp"

#include <gtest/gtest.h>

namespace gridmerge {
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

}  // namespace
}  // namespace gridmerge
