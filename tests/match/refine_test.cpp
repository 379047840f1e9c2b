// SPDX-License-Identifier: Apache-2.0
#include "match/refine.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "support/building.hpp"

namespace gridmerge {

using namespace internal;
namespace {

TEST(PoseMetric, DisplacementIsTheRmsOverAllWalls) {
  const LikelihoodField map = make_likelihood_field(test::draw_building(1), 0.1);
  const PoseMetric metric = make_pose_metric(map);
  const SE2 a{3.0, -2.0, 0.4};
  const SE2 b{5.0, 1.0, -0.3};
  double sum = 0.0;
  for (const WallPoint& wall : map.walls) {
    const Point2 p = a * wall.position;
    const Point2 q = b * wall.position;
    sum += (p.x - q.x) * (p.x - q.x) + (p.y - q.y) * (p.y - q.y);
  }
  EXPECT_NEAR(metric.displacement(a, b), std::sqrt(sum / static_cast<double>(map.walls.size())), 1e-6);
  EXPECT_EQ(metric.displacement(a, a), 0.0);
}

TEST(PoseMetric, MovesShiftThePivotAndTurnAboutIt) {
  const PoseMetric metric{{10.0, 20.0}, 5.0};
  const SE2 from{1.0, 2.0, 0.5};
  const SE2 to = metric.moved(from, 0.25, -0.5, 0.1);
  EXPECT_NEAR((to * metric.pivot).x, (from * metric.pivot).x + 0.25, 1e-12);
  EXPECT_NEAR((to * metric.pivot).y, (from * metric.pivot).y - 0.5, 1e-12);
  EXPECT_NEAR(to.theta, 0.6, 1e-12);
}

TEST(Refine, ClimbsBackToTheTruthAndKeepsHypothesesApart) {
  const LikelihoodField map = make_likelihood_field(test::draw_building(1), 0.1);
  const PoseMetric metric = make_pose_metric(map);
  RefineOptions options;
  std::vector<PoseCandidate> candidates;
  for (const double dx : {-40.0, -2.0, 2.0, 40.0}) {
    for (const double turn : {-0.02, 0.02, 1.5}) candidates.push_back({metric.moved({}, dx, 1.0, turn), 1});
  }
  double last_share = 0.0;
  const WallEvidence evidence(map, map, std::numeric_limits<std::size_t>::max());
  const auto found = refine(evidence, map, candidates, options, [&](double share) {
    EXPECT_GE(share, last_share);
    last_share = share;
  });
  EXPECT_EQ(last_share, 1.0);
  ASSERT_FALSE(found.empty());
  EXPECT_LT(metric.displacement(found.front().T_fixed_moving, {}), 0.3);
  for (std::size_t i = 0; i < found.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      EXPECT_LE(found[i].evidence.score, found[j].evidence.score);
      EXPECT_GE(metric.displacement(found[i].T_fixed_moving, found[j].T_fixed_moving), options.distinct);
    }
  }
}

TEST(RankOf, IsTheScoreOrWhatItIsForTheWallsSeen) {
  const Evidence much{100.0, {}, 400.0}, little{60.0, {}, 50.0};
  EXPECT_EQ(rank_of(much, RankBy::amount), 100.0);
  EXPECT_GT(rank_of(much, RankBy::amount), rank_of(little, RankBy::amount));
  EXPECT_LT(rank_of(much, RankBy::quality), rank_of(little, RankBy::quality));
  EXPECT_EQ(rank_of({5.0, {}, 0.0}, RankBy::quality), 5.0);  // of next to no walls it is the score
}

// Of many candidates with much in common, as many poses come out as were asked for, at a distance from each
// other, whichever way they are ranked: the true one first.
TEST(Refine, KeepsAsManyDistinctPosesAsWereAskedFor) {
  const LikelihoodField map = make_likelihood_field(test::draw_building(1), 0.1);
  const PoseMetric metric = make_pose_metric(map);
  const WallEvidence evidence(map, map, std::numeric_limits<std::size_t>::max());
  std::vector<PoseCandidate> candidates;
  for (int x = -15; x <= 15; ++x) {
    for (int y = -10; y <= 10; ++y) {
      // By scores that are no order, and the true pose last of all.
      if (x != 0 || y != 0) candidates.push_back({metric.moved({}, 5.0 * x, 5.0 * y, 0.0), 0});
    }
  }
  candidates.push_back({metric.moved({}, 0.7, -0.6, 0.004), 0});
  for (const RankBy rank : {RankBy::amount, RankBy::quality}) {
    for (const std::size_t most : {1U, 6U, 12U}) {
      RefineOptions options;
      options.distinct = 8.0;
      options.max_poses = most;
      options.rank = rank;
      const std::vector<ScoredPose> found = refine(evidence, map, candidates, options);
      ASSERT_EQ(found.size(), most);
      EXPECT_LT(metric.displacement(found[0].T_fixed_moving, {}), 0.75);
      for (std::size_t i = 0; i < found.size(); ++i) {
        EXPECT_EQ(found[i].evidence.score, evidence(found[i].T_fixed_moving).score);
        for (std::size_t j = 0; j < i; ++j) {
          EXPECT_LE(rank_of(found[i].evidence, rank), rank_of(found[j].evidence, rank));
          EXPECT_GE(metric.displacement(found[i].T_fixed_moving, found[j].T_fixed_moving), options.distinct);
        }
      }
    }
  }
}

// Each result is at the top of its hill, as far as steps of a cell show.
TEST(Climb, EndsWhereNoStepHelps) {
  const LikelihoodField map = make_likelihood_field(test::draw_building(2), 0.1);
  const PoseMetric metric = make_pose_metric(map);
  const WallEvidence evidence(map, map, 500);
  for (const SE2& start : {SE2{3.0, -2.0, 0.01}, SE2{30.0, 12.0, 1.0}, SE2{-9.0, 4.0, -0.3}}) {
    const ScoredPose top = climb(evidence, metric, start, 2.0, 0.5);
    EXPECT_GE(top.evidence.score, evidence(start).score);
    EXPECT_EQ(top.evidence.score, evidence(top.T_fixed_moving).score);
    for (const double sign : {-0.5, 0.5}) {
      for (const SE2& step : {metric.moved(top.T_fixed_moving, sign, 0.0, 0.0),
                              metric.moved(top.T_fixed_moving, 0.0, sign, 0.0),
                              metric.moved(top.T_fixed_moving, 0.0, 0.0, sign / metric.radius)})
        EXPECT_LE(evidence(step).score, top.evidence.score);
    }
  }
}

TEST(Refine, NoCandidatesNoPoses) {
  const LikelihoodField map = make_likelihood_field(test::draw_building(1), 0.1);
  EXPECT_TRUE(refine(WallEvidence(map, map, 1000), map, {}, {}).empty());
}

}  // namespace
}  // namespace gridmerge
