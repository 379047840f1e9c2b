// SPDX-License-Identifier: Apache-2.0
#include "gridmerge/match/refine.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "support/building.hpp"

namespace gridmerge {
namespace {

TEST(PoseMetric, DisplacementIsTheRmsOverAllWalls) {
  const WallMap map = make_wall_map(test::draw_building(1), 0.1);
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
  const WallMap map = make_wall_map(test::draw_building(1), 0.1);
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

TEST(Refine, NoCandidatesNoPoses) {
  const WallMap map = make_wall_map(test::draw_building(1), 0.1);
  EXPECT_TRUE(refine(WallEvidence(map, map, 1000), map, {}, {}).empty());
}

}  // namespace
}  // namespace gridmerge
