// SPDX-License-Identifier: Apache-2.0
#include "gridmerge/search/random_walk.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "../similarity/random_grid.hpp"
#include "gridmerge/grid/execution.hpp"
#include "gridmerge/grid/resample.hpp"
#include "support/building.hpp"
#include "support/effort.hpp"

namespace gridmerge {

namespace {

double error_at(const Point2& p, const SE2& found, const SE2& truth) {
  const Point2 a = found * p;
  const Point2 b = truth * p;
  return std::hypot(a.x - b.x, a.y - b.y);
}

TEST(StartPoses, AreTheRotationsTimesTheShiftsOfTheCentre) {
  const OccupancyGrid fixed = test::random_grid(1, 40, 30);
  const OccupancyGrid moving = test::random_grid(2, 20, 26);
  StartPoseOptions options;
  options.offset = 4.0;
  const auto starts = measure_start_poses(fixed, moving, options);
  ASSERT_EQ(starts.size(), 72U * 9U);
  const auto centre_of = [](const OccupancyGrid& map) {
    const OccupancyGrid known = crop_to_known(map);
    return known.origin * Point2{0.5 * known.width * known.resolution, 0.5 * known.height * known.resolution};
  };
  const Point2 fixed_centre = centre_of(fixed);
  const double step = 4.0 * fixed.resolution;
  for (std::size_t i = 0; i < starts.size(); ++i) {
    const Point2 centre = starts[i].T_fixed_moving * centre_of(moving);
    EXPECT_NEAR(centre.x - fixed_centre.x, step * (static_cast<int>(i % 3) - 1), 1e-9);
    EXPECT_NEAR(centre.y - fixed_centre.y, step * (static_cast<int>(i / 3 % 3) - 1), 1e-9);
    const double turn =
        starts[i].T_fixed_moving.theta - 5.0 * std::numbers::pi / 180.0 * static_cast<double>(i / 9);
    EXPECT_NEAR(std::remainder(turn, 2.0 * std::numbers::pi), 0.0, 1e-9);
    EXPECT_EQ(starts[i].similarity.psi(), measure_similarity(fixed, moving, starts[i].T_fixed_moving).psi());
  }
}

TEST(StartPoses, DoNotDependOnThreads) {
  const OccupancyGrid fixed = test::random_grid(1, 40, 30);
  std::vector<std::vector<MeasuredPose>> runs;
  for (const int threads : {1, 2})
    with_threads(threads, [&] { runs.push_back(measure_start_poses(fixed, fixed)); });
  for (std::size_t i = 0; i < runs[0].size(); ++i)
    EXPECT_EQ(runs[0][i].similarity.delta(2.0), runs[1][i].similarity.delta(2.0));
}

TEST(StartPoses, RefuseOptionsThatMakeNoSense) {
  const OccupancyGrid map = test::random_grid(1, 20, 20);
  EXPECT_THROW(measure_start_poses(map, map, {0, 1, 100.0}), std::invalid_argument);
  EXPECT_THROW(measure_start_poses(map, map, {72, -1, 100.0}), std::invalid_argument);
  EXPECT_THROW(measure_start_poses(map, map, {72, 1, -1.0}), std::invalid_argument);
  EXPECT_THROW(measure_start_poses(map, map, {1 << 30, 1 << 30, 1.0}), std::invalid_argument);
  EXPECT_THROW(measure_start_poses(map, map, {72, 1, std::nan("")}), std::invalid_argument);
}

/// A building and the same one seen from elsewhere, cells of 0.1 m.
struct EasyPair {
  OccupancyGrid fixed = downsample(test::draw_building(3), 2);
  SE2 T_moving_fixed{4.0, -2.0, 0.8};
  OccupancyGrid moving = transform_grid(fixed, T_moving_fixed, fixed.resolution);
  /// Off by some cells and degrees.
  SE2 start = SE2{0.6, -0.5, 0.06} * inverse(T_moving_fixed);
};

TEST(RandomWalk, ConvergesFromNearTheTruth) {
  const EasyPair pair;
  int right = 0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    RandomWalkOptions options;
    options.seed = seed;
    const RandomWalkResult result = random_walk(pair.fixed, pair.moving, pair.start, options);
    right += error_at({10.0, 5.0}, result.T_fixed_moving, inverse(pair.T_moving_fixed)) < 0.3 ? 1 : 0;
  }
  EXPECT_GE(right, 9);
}

TEST(RandomWalk, ASeedReproducesItBitForBit) {
  const EasyPair pair;
  RandomWalkOptions options;
  options.temperature = 0.3;
  options.patience = 300;
  options.trace = WalkTrace::accepted;
  options.seed = 5;
  const RandomWalkResult one = random_walk(pair.fixed, pair.moving, pair.start, options);
  const RandomWalkResult again = random_walk(pair.fixed, pair.moving, pair.start, options);
  EXPECT_EQ(one.T_fixed_moving, again.T_fixed_moving);
  EXPECT_EQ(one.delta, again.delta);
  EXPECT_EQ(one.proposals, again.proposals);
  ASSERT_EQ(one.trace.size(), again.trace.size());
  for (std::size_t i = 0; i < one.trace.size(); ++i) {
    EXPECT_EQ(one.trace[i].T_fixed_moving, again.trace[i].T_fixed_moving);
    EXPECT_EQ(one.trace[i].delta, again.trace[i].delta);
  }
  options.seed = 6;
  EXPECT_FALSE(random_walk(pair.fixed, pair.moving, pair.start, options).T_fixed_moving ==
               one.T_fixed_moving);
}

TEST(RandomWalk, TheTraceTellsTheWalk) {
  const EasyPair pair;
  RandomWalkOptions options;
  options.temperature = 0.3;
  options.c_lock = 0.5;
  options.patience = 300;
  options.trace = WalkTrace::accepted;
  const RandomWalkResult result = random_walk(pair.fixed, pair.moving, pair.start, options);
  ASSERT_EQ(result.trace.size(), result.accepted + 1);
  EXPECT_EQ(result.trace.front().step, 0U);
  EXPECT_EQ(result.trace.front().T_fixed_moving, pair.start);
  double least = result.trace.front().delta;
  for (std::size_t i = 0; i < result.trace.size(); ++i) {
    const WalkSample& sample = result.trace[i];
    EXPECT_TRUE(i == 0 || sample.step > result.trace[i - 1].step);
    EXPECT_DOUBLE_EQ(sample.delta,
                     measure_similarity(pair.fixed, pair.moving, sample.T_fixed_moving).delta(0.5));
    EXPECT_EQ(sample.delta, sample.similarity.delta(0.5));
    EXPECT_TRUE(sample.accepted && sample.measured);
    least = std::min(least, sample.delta);
  }
  EXPECT_EQ(least, result.delta);
  EXPECT_LE(result.trace.back().step, result.proposals);
}

TEST(RandomWalk, TheWholeTraceHoldsEveryProposal) {
  const EasyPair pair;
  RandomWalkOptions options;
  options.patience = 1500;
  options.trace = WalkTrace::all;
  options.wide_share = 0.2;
  const RandomWalkResult result = random_walk(pair.fixed, pair.moving, pair.start, options);
  std::vector<std::size_t> entries(result.proposals + 1, 0);
  std::size_t accepted = 0, wide = 0, kept = 0;
  std::vector<SE2> refused_wide;
  int undefined = 4;
  for (const WalkSample& sample : result.trace) {
    EXPECT_TRUE(sample.measured || !sample.accepted) << sample.step;
    if (++entries[sample.step] == 2) {  // the walk went to one that it had refused before
      ++kept;
      EXPECT_TRUE(sample.accepted && sample.wide) << sample.step;
      EXPECT_NE(std::find(refused_wide.begin(), refused_wide.end(), sample.T_fixed_moving),
                refused_wide.end());
    }
    if (sample.wide && !sample.accepted) refused_wide.push_back(sample.T_fixed_moving);
    if (sample.accepted) {
      EXPECT_LE(sample.similarity.undefined_terms(), undefined) << sample.step;
      undefined = sample.similarity.undefined_terms();
    }
    accepted += sample.accepted ? 1 : 0;
    wide += sample.wide ? 1 : 0;
    if (!sample.measured) continue;
    EXPECT_EQ(sample.delta, sample.similarity.psi());
  }
  EXPECT_EQ(accepted, result.accepted + 1);
  for (const std::size_t count : entries) EXPECT_TRUE(count == 1 || count == 2);
  EXPECT_GT(kept, 0U);
  EXPECT_NEAR(static_cast<double>(wide) / static_cast<double>(result.proposals), 0.2, 0.05);
  // What a walk does is not changed by what is told of it.
  options.trace = WalkTrace::accepted;
  const RandomWalkResult again = random_walk(pair.fixed, pair.moving, pair.start, options);
  EXPECT_EQ(again.T_fixed_moving, result.T_fixed_moving);
  EXPECT_EQ(again.trace.size(), accepted);
}

constexpr int kWrongStarts = test::repeats(4, 1);

/// Of the wrong starts, from how many the walk reaches the truth.
int count_arrivals(double c_lock, double wide_share, std::uint64_t seed) {
  const EasyPair pair;
  const SE2 truth = inverse(pair.T_moving_fixed);
  const Point2 centre = pair.T_moving_fixed * Point2{9.0, 6.5};  // of the building, in the moving map
  const std::array<SE2, 4> starts{SE2{0.0, 0.0, 3.1}, SE2{6.0, 0.0, 1.6}, SE2{0.0, -6.0, -1.6},
                                  SE2{-4.0, 4.0, 2.4}};
  int arrived = 0;
  for (const SE2& wrong : std::span(starts).first(kWrongStarts)) {
    const SE2 turned{0.0, 0.0, truth.theta + wrong.theta};
    const Point2 at = turned * centre;
    RandomWalkOptions options;
    options.c_lock = c_lock;
    options.wide_share = wide_share;
    options.seed = seed;
    options.patience = 10000;
    options.max_proposals = 40000;
    const SE2 start{9.0 + wrong.x - at.x, 6.5 + wrong.y - at.y, turned.theta};
    const RandomWalkResult result = random_walk(pair.fixed, pair.moving, start, options);
    const bool right = error_at(centre, result.T_fixed_moving, truth) < 0.5 &&
                       error_at({0.0, 0.0}, result.T_fixed_moving, truth) < 1.0;
    arrived += right ? 1 : 0;
  }
  return arrived;
}

class FromWrongPlaces : public testing::TestWithParam<double> {};

TEST_P(FromWrongPlaces, WideProposalsLeadOut) {
  EXPECT_EQ(count_arrivals(GetParam(), RandomWalkOptions{}.wide_share, 1), kWrongStarts);
}

TEST_P(FromWrongPlaces, NothingElseDoes) {
  EXPECT_EQ(count_arrivals(GetParam(), 0.0, 1), 0);
}

INSTANTIATE_TEST_SUITE_P(RandomWalk, FromWrongPlaces, testing::Values(7.5));

TEST(RandomWalk, WideProposalsReachAllPosesAlike) {
  const OccupancyGrid map = test::random_grid(1, 30, 30);
  RandomWalkOptions options;
  options.wide_share = 1.0;
  options.trace = WalkTrace::all;
  options.patience = options.max_proposals = 4000;
  const RandomWalkResult result = random_walk(map, map, {}, options);
  const Point2 centre{1.5, 1.5};
  int left = 0, turned = 0, inner = 0;
  for (const WalkSample& sample : result.trace) {
    const Point2 at = sample.T_fixed_moving * centre;
    const double distance = std::hypot(at.x - centre.x, at.y - centre.y);
    EXPECT_LE(distance, 2.0 * std::hypot(1.5, 1.5) + 1e-9);
    left += at.x < centre.x ? 1 : 0;
    turned += sample.T_fixed_moving.theta > 0.5 * std::numbers::pi ? 1 : 0;
    inner += distance < std::hypot(1.5, 1.5) ? 1 : 0;
  }
  EXPECT_NEAR(left, 2000, 200);
  EXPECT_NEAR(turned, 1000, 150);
  EXPECT_NEAR(inner, 1000, 150);  // half the radius is a quarter of the disc
}

TEST(Landscape, ACutGoesStraightAndItsPosesAreMeasured) {
  const EasyPair pair;
  const SE2 truth = inverse(pair.T_moving_fixed);
  const SE2 end{truth.x + 2.0, truth.y, truth.theta};
  const std::vector<SE2> cut = poses_between(pair.moving, truth, end, 5);
  ASSERT_EQ(cut.size(), 5U);
  EXPECT_EQ(cut.back(), end);
  EXPECT_NEAR(cut[2].x, truth.x + 1.0, 1e-9);
  EXPECT_NEAR(cut[2].theta, truth.theta, 1e-12);
  const std::vector<MeasuredPose> landscape = measure_poses(pair.fixed, pair.moving, cut);
  for (std::size_t i = 0; i < cut.size(); ++i) {
    const ImageSimilarity expected = measure_similarity(pair.fixed, pair.moving, cut[i]);
    EXPECT_EQ(landscape[i].similarity.psi(), expected.psi());
    EXPECT_EQ(landscape[i].similarity.omega, expected.omega);
    EXPECT_TRUE(i == 0 || landscape[i].similarity.psi() > landscape[0].similarity.psi());
  }
  EXPECT_THROW(poses_between(pair.moving, truth, end, 1), std::invalid_argument);
  EXPECT_THROW(poses_between(pair.moving, truth, {std::nan(""), 0.0, 0.0}, 3), std::invalid_argument);
}

TEST(RandomWalk, HillClimbingNeverGoesBack) {
  const EasyPair pair;
  RandomWalkOptions options;
  options.wide_share = 0.0;
  options.patience = 300;
  options.trace = WalkTrace::accepted;
  const RandomWalkResult result = random_walk(pair.fixed, pair.moving, pair.start, options);
  ASSERT_GE(result.trace.size(), 3U);
  EXPECT_EQ(result.trace.size(), result.accepted + 1);
  for (std::size_t i = 1; i < result.trace.size(); ++i)
    EXPECT_LT(result.trace[i].delta, result.trace[i - 1].delta);
}

TEST(RandomWalk, TemperatureAcceptsWorseSamplesAndCoolingEndsIt) {
  const EasyPair pair;
  RandomWalkOptions options;
  options.patience = 400;
  options.trace = WalkTrace::accepted;
  options.temperature = 2.0;
  options.wide_share = 0.0;
  const auto count_worse = [&](std::size_t from_step) {
    const RandomWalkResult result = random_walk(pair.fixed, pair.moving, pair.start, options);
    int worse = 0;
    for (std::size_t i = 1; i < result.trace.size(); ++i)
      worse += result.trace[i].step > from_step && result.trace[i].delta >= result.trace[i - 1].delta ? 1 : 0;
    return worse;
  };
  const int hot = count_worse(0);
  EXPECT_GT(hot, 10);
  // The colder it is, the fewer are accepted.
  options.temperature = 0.5;
  const int cold = count_worse(0);
  EXPECT_GT(cold, 3);
  options.temperature = 1e-6;
  EXPECT_LT(count_worse(0), cold);
  options.temperature = 2.0;
  options.cooling = 0.9;
  EXPECT_EQ(count_worse(200), 0);  // 2 * 0.9^200 is nothing
}

TEST(RandomWalk, AMapIsNotLostBetweenTheCellsOfACoarseOne) {
  // A moving map of half a cell can be drawn nowhere; that must not pass for a perfect fit.
  OccupancyGrid fixed = test::random_grid(1, 20, 20);
  fixed.resolution = 5.0;
  OccupancyGrid moving = test::random_grid(2, 30, 30);
  moving.resolution = 0.1;
  const RandomWalkResult result = random_walk(fixed, moving, {50.0, 50.0, 0.3});
  EXPECT_GT(result.similarity.agreement + result.similarity.disagreement, 0);
}

TEST(RandomWalk, AStartOffTheMapFindsBack) {
  const OccupancyGrid map = test::random_grid(1, 40, 40);
  RandomWalkOptions options;
  options.patience = 500;
  int back = 0;
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    options.seed = seed;
    const SE2 start{120.0 * map.resolution, 0.0, 0.2};
    const RandomWalkResult result = random_walk(map, map, start, options);
    back += result.similarity.agreement > 0 ? 1 : 0;
  }
  EXPECT_GE(back, 4);
}

TEST(RandomWalk, ProposalsFollowTheAcceptedSteps) {
  // A slope without end in one direction: the steps grow along it.
  OccupancyGrid fixed = make_grid(2000, 12, 0.1);
  OccupancyGrid moving = make_grid(12, 12, 0.1, {}, Cell::free);
  fixed.at(1990, 6) = Cell::free;
  fixed.at(1991, 6) = moving.at(6, 6) = Cell::occupied;
  fixed.at(0, 0) = Cell::free;
  RandomWalkOptions options;
  options.first_step = 1.0;
  options.wide_share = 0.0;
  options.patience = 300;
  options.trace = WalkTrace::accepted;
  const RandomWalkResult result = random_walk(fixed, moving, {1.0, 0.0, 0.0}, options);
  double longest = 0.0;
  for (std::size_t i = 1; i < result.trace.size(); ++i) {
    const double step = result.trace[i].T_fixed_moving.x - result.trace[i - 1].T_fixed_moving.x;
    longest = std::max(longest, std::abs(step) / fixed.resolution);
  }
  EXPECT_GT(longest, 10.0);  // of a first step of one cell
}

TEST(StartPoses, OneThatIsTooFarToBeMeasuredIsTheWorst) {
  const OccupancyGrid tunnel = make_grid(31990, 1, 0.1, {}, Cell::free);
  OccupancyGrid moving = make_grid(2, 1, 0.1, {}, Cell::free);
  moving.at(0, 0) = Cell::occupied;
  StartPoseOptions options;
  options.rotations = 1;
  const std::vector<MeasuredPose> starts = measure_start_poses(tunnel, moving, options);
  ASSERT_EQ(starts.size(), 9U);
  EXPECT_EQ(starts[0].similarity.undefined_terms(), 4);
  EXPECT_EQ(starts[4].similarity.undefined_terms(), 2);  // on each other; the tunnel has no wall
}

TEST(RandomWalk, StopsWhenItsPatienceOrItsProposalsRunOut) {
  const OccupancyGrid map = test::random_grid(1, 30, 30);
  RandomWalkOptions options;
  options.patience = 50;
  EXPECT_EQ(random_walk(map, map, {}, options).proposals, 50U);  // nothing is better than the truth
  options.patience = 1000;
  options.max_proposals = 20;
  EXPECT_EQ(random_walk(map, map, {}, options).proposals, 20U);
}

TEST(RandomWalk, MapsWithoutAClassAreWalkedAllTheSame) {
  const OccupancyGrid free = make_grid(20, 20, 0.1, {}, Cell::free);
  RandomWalkOptions options;
  options.patience = 50;
  const RandomWalkResult result = random_walk(free, free, {0.3, 0.0, 0.0}, options);
  EXPECT_EQ(result.similarity.undefined_terms(), 2);
  EXPECT_LE(result.delta, measure_similarity(free, free, {0.3, 0.0, 0.0}).psi());
}

TEST(RandomWalk, RefusesOptionsThatMakeNoSense) {
  const OccupancyGrid map = test::random_grid(1, 20, 20);
  const auto refused = [&](auto change) {
    RandomWalkOptions options;
    change(options);
    EXPECT_THROW(random_walk(map, map, {}, options), std::invalid_argument);
  };
  refused([](auto& o) { o.c_lock = -1.0; });
  refused([](auto& o) { o.c_lock = std::nan(""); });
  refused([](auto& o) { o.memory = 3; });
  refused([](auto& o) { o.first_step = 0.0; });
  refused([](auto& o) { o.first_step = 50.0; });
  refused([](auto& o) { o.smallest_step = 50.0; });
  refused([](auto& o) { o.temperature = -1.0; });
  refused([](auto& o) { o.cooling = 1.001; });
  refused([](auto& o) { o.cooling = 0.0; });
  refused([](auto& o) { o.wide_share = -0.01; });
  refused([](auto& o) { o.wide_share = 1.01; });
  refused([](auto& o) { o.wide_share = std::nan(""); });
  refused([](auto& o) { o.patience = 0; });
  refused([](auto& o) { o.max_proposals = 0; });
  RandomWalkOptions least;
  least.memory = 4;
  least.smallest_step = least.first_step = least.largest_step = 2.0;
  least.cooling = least.wide_share = 1.0;
  least.patience = least.max_proposals = 1;
  EXPECT_EQ(random_walk(map, map, {}, least).proposals, 1U);
  EXPECT_THROW(random_walk(map, map, {std::nan(""), 0.0, 0.0}), std::invalid_argument);
}

}  // namespace
}  // namespace gridmerge
