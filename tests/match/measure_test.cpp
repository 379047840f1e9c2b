// SPDX-License-Identifier: Apache-2.0
#include "gridmerge/match/measure.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "gridmerge/grid/resample.hpp"
#include "gridmerge/similarity/image_similarity.hpp"
#include "support/building.hpp"

namespace gridmerge {
namespace {

/// A building, and the same one seen from elsewhere.
struct Pair {
  OccupancyGrid fixed = downsample(test::draw_building(3), 2);
  SE2 T_moving_fixed{4.0, -2.0, 0.8};
  OccupancyGrid moving = transform_grid(fixed, T_moving_fixed, fixed.resolution);
  SE2 truth = inverse(T_moving_fixed);
};

TEST(MeasurePose, HoldsWhatTheMeasuresSayByThemselves) {
  const Pair pair;
  const PoseMeasure found = measure_pose(pair.fixed, pair.moving, pair.truth);
  const ImageSimilarity similarity = measure_similarity(pair.fixed, pair.moving, pair.truth);
  EXPECT_EQ(found.T_fixed_moving, pair.truth);
  EXPECT_EQ(found.cells, static_cast<std::int64_t>(pair.fixed.cells.size()));
  EXPECT_EQ(found.similarity.psi(), similarity.psi());
  EXPECT_EQ(found.similarity.omega, count_equal_cells(pair.fixed, pair.moving, pair.truth));
  EXPECT_EQ(found.similarity.agreement, similarity.agreement);
  EXPECT_EQ(found.common.occupied_occupied + found.common.free_free, similarity.agreement);
}

TEST(MeasurePose, TheEngineSaysWhatItSaysOfItsOwnHypothesis) {
  const Pair pair;
  for (const bool swapped : {false, true}) {
    const OccupancyGrid &fixed = swapped ? pair.moving : pair.fixed,
                        &moving = swapped ? pair.fixed : pair.moving;
    const Hypothesis best = match(fixed, moving).hypotheses.front();
    const Hypothesis judged = measure_pose(fixed, moving, best.T_fixed_moving).engine;
    EXPECT_EQ(judged.T_fixed_moving, best.T_fixed_moving);
    EXPECT_NEAR(judged.probability, best.probability, 1e-6);
    for (const PoseFigure& figure : pose_figures()) {
      const double expected = best.figures.*figure.value;
      EXPECT_NEAR(judged.figures.*figure.value, expected, 1e-6 * std::max(1.0, std::abs(expected)))
          << figure.name;
    }
  }
}

TEST(MeasurePose, AWrongPoseHasNoProbability) {
  const Pair pair;
  const SE2 wrong = SE2{3.0, 1.0, 0.5} * pair.truth;
  EXPECT_LT(measure_pose(pair.fixed, pair.moving, wrong).engine.probability, 0.01);
}

TEST(MeasureMaps, OmegaIsOfAllMapsTogether) {
  const Pair pair;
  const SE2 aside = SE2{1.0, 0.0, 0.0} * pair.truth;
  const std::array<PlacedMap, 2> moving{{{&pair.moving, pair.truth}, {&pair.moving, aside}}};
  const JointMeasure joint = measure_maps(pair.fixed, moving);
  const std::array<PlacedMap, 3> all{{{&pair.fixed, {}}, moving[0], moving[1]}};
  EXPECT_EQ(joint.omega, count_equal_cells(pair.fixed, all));
  ASSERT_EQ(joint.pairs.size(), 2U);
  EXPECT_LT(joint.omega, joint.pairs[0].similarity.omega);
  EXPECT_LE(joint.omega, joint.pairs[1].similarity.omega);
}

TEST(MeasureMaps, ThreadsChangeNothing) {
  const Pair pair;
  const PoseMeasure one = measure_pose(pair.fixed, pair.moving, pair.truth, 1);
  const PoseMeasure two = measure_pose(pair.fixed, pair.moving, pair.truth, 2);
  EXPECT_EQ(one.engine.probability, two.engine.probability);
  EXPECT_EQ(one.engine.score, two.engine.score);
}

TEST(MeasureMaps, MapsWithoutCellsAreMeasuredAllTheSame) {
  for (const Cell fill : {Cell::unknown, Cell::free, Cell::occupied}) {
    const OccupancyGrid map = make_grid(20, 20, 0.1, {}, fill);
    const PoseMeasure found = measure_pose(map, map, {});
    EXPECT_EQ(found.similarity.omega, 400);
    EXPECT_EQ(found.similarity.undefined_terms(), fill == Cell::unknown ? 4 : 2);
    EXPECT_LE(found.engine.probability, 0.5);
  }
}

TEST(MeasureMaps, RefusesMapsThatLieApart) {
  const Pair pair;
  EXPECT_THROW(measure_pose(pair.fixed, pair.moving, {200.0, 0.0, 0.0}), std::invalid_argument);
  EXPECT_THROW(measure_pose(pair.fixed, pair.moving, {1e9, 0.0, 0.0}), std::invalid_argument);
  EXPECT_THROW(measure_pose(pair.fixed, pair.moving, {0.0, 0.0, std::nan("")}), std::invalid_argument);
  EXPECT_THROW(measure_pose(pair.fixed, pair.moving, {}, -1), std::invalid_argument);
  EXPECT_THROW(measure_maps(pair.fixed, {}), std::invalid_argument);
  EXPECT_THROW(measure_maps(pair.fixed, std::array{PlacedMap{}}), std::invalid_argument);
  // A map that lies on another moving map only is in its place.
  const SE2 beside = SE2{15.0, 0.0, 0.0} * pair.truth, far = SE2{30.0, 0.0, 0.0} * pair.truth;
  std::array<PlacedMap, 2> chain{{{&pair.moving, beside}, {&pair.moving, far}}};
  EXPECT_FALSE(lie_on_each_other(pair.fixed, pair.moving, far));
  EXPECT_EQ(measure_maps(pair.fixed, chain).pairs[1].similarity.agreement, 0);
  chain[1].T_output_map.x += 200.0;
  EXPECT_THROW(measure_maps(pair.fixed, chain), std::invalid_argument);
}

TEST(MeasurePose, OfAMapThatNobodyHasSeenNothingOverlaps) {
  const OccupancyGrid building = test::draw_building(1);
  const PoseMeasure found = measure_pose(building, make_grid(60, 40, 0.05, {}, Cell::occupied), {});
  EXPECT_EQ(found.engine.figures.common_area, 0.0);
  EXPECT_EQ(found.engine.figures.overlap, 0.0);
}

}  // namespace
}  // namespace gridmerge
