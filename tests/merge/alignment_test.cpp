// SPDX-License-Identifier: Apache-2.0
#include "merge/alignment.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <optional>
#include <random>

#include "grid/pose_bounds.hpp"
#include "merge/coverage.hpp"
#include "merge/pose_graph.hpp"
#include "merge/wall_error.hpp"
#include "support/building.hpp"

namespace gridmerge {

using namespace internal;
namespace {

/// A map that knows nothing, so that only what is measured counts.
struct Blank {
  OccupancyGrid grid = make_grid(4, 4, 0.1);
  PreparedMap prepared{grid};
  MapExtent extent{{1.0, 2.0}, 5.0, 20.0};
};

TEST(Align, MeetsWhatIsMeasured) {
  const Blank blank;
  const SE2 T01{3.0, 1.0, 0.5}, T12{-2.0, 4.0, 1.0};
  const std::vector<AlignedMap> maps(3, {&blank.prepared, {}, blank.extent, {}});
  const std::vector<RelativePose> measured{measured_between(0, 1, T01, blank.extent, blank.extent, 0.1),
                                           measured_between(1, 2, T12, blank.extent, blank.extent, 0.1)};
  const std::vector<SE2> poses = align(maps, measured);
  EXPECT_EQ(poses[0], SE2{});
  EXPECT_LT(displacement(blank.extent, poses[1], T01), 1e-6);
  EXPECT_LT(displacement(blank.extent, poses[2], T01 * T12), 1e-6);
}

// More poses than fit a dense solver, in a ring that does not close by itself: every join gives a little.
TEST(AdjustPoses, OfManyMapsShareTheErrorOfARing) {
  for (const std::size_t count : {12U, 40U}) {
    const MapExtent extent{{0.0, 0.0}, 5.0, 20.0};
    const double turn = 2.0 * std::numbers::pi / static_cast<double>(count);
    const SE2 step{10.0, 0.0, turn}, longer{10.4, 0.0, turn};
    std::vector<AdjustablePose> poses(1, {SE2{}, {}, true});
    std::vector<RelativePose> measured;
    for (std::size_t i = 0; i < count; ++i) {
      if (i > 0) poses.push_back({poses.back().pose * step, {}, false});
      measured.push_back(measured_between(i, (i + 1) % count, i == 3 ? longer : step, extent, extent, 0.5));
    }
    const std::vector<SE2> adjusted = adjust_poses(poses, measured);
    EXPECT_EQ(adjusted[0], SE2{});
    double most = 0.0;
    for (std::size_t i = 0; i < count; ++i) {
      const SE2 found = inverse(adjusted[i]) * adjusted[(i + 1) % count];
      most = std::max(most, displacement(extent, found, measured[i].T_fixed_moving));
    }
    EXPECT_LT(most, 0.3) << count;  // of 0.4 m, were one join to bear it
    EXPECT_GT(most, 0.001) << count;
  }
}

// Ceres computes in the order of its parameters' addresses, which come from the heap.
TEST(FindDeviations, AreTheSameBitsWhateverTheHeapHolds) {
  const Blank blank;
  std::mt19937 dice(7);
  std::uniform_real_distribution<double> some(0.0, 1.0);
  constexpr std::size_t kMaps = 60;
  const std::vector<AlignedMap> maps(kMaps, {&blank.prepared, {}, blank.extent, {}});
  std::vector<RelativePose> measured;
  for (std::size_t moving = 1; moving < kMaps; ++moving)
    for (int i = 0; i < 3; ++i) {
      const SE2 T{5.0 * some(dice), 5.0 * some(dice), some(dice)};
      measured.push_back(
          measured_between(dice() % moving, moving, T, blank.extent, blank.extent, 0.1 + some(dice)));
    }
  const auto before = find_deviations(maps, measured, 0);

  std::vector<std::unique_ptr<char[]>> held;
  for (int i = 0; i < 3000; ++i) held.push_back(std::make_unique<char[]>(16 + dice() % 1500));
  std::shuffle(held.begin(), held.end(), dice);
  held.resize(held.size() / 2);  // holes of any size, and no order
  const auto after = find_deviations(maps, measured, 0);
  for (std::size_t i = 0; i < kMaps; ++i) {
    EXPECT_EQ(before[i]->position, after[i]->position) << i;
    EXPECT_EQ(before[i]->theta, after[i]->theta) << i;
  }
}

TEST(FindDeviations, AddUpAlongAChainAndShrinkInACycle) {
  const Blank blank;
  const std::vector<AlignedMap> maps(3, {&blank.prepared, {}, blank.extent, {}});
  std::vector<RelativePose> measured{measured_between(0, 1, {}, blank.extent, blank.extent, 0.1),
                                     measured_between(1, 2, {}, blank.extent, blank.extent, 0.1)};
  const std::vector<std::optional<PoseDeviation>> chain = find_deviations(maps, measured, 0);
  EXPECT_EQ(chain[0]->position, 0.0);
  EXPECT_NEAR(chain[1]->position, 0.1 * std::sqrt(2.0), 1e-6);  // in x and in y
  EXPECT_NEAR(chain[1]->theta, 0.1 / 5.0, 1e-6);
  EXPECT_NEAR(chain[2]->position, 0.2, 1e-6);
  EXPECT_NEAR(find_deviations(maps, measured, 2)[0]->position, 0.2, 1e-6);
  measured.push_back(measured_between(0, 2, {}, blank.extent, blank.extent, 0.1));
  EXPECT_NEAR(find_deviations(maps, measured, 0)[2]->position, 0.1 * std::sqrt(2.0 * 2.0 / 3.0), 1e-6);
}

TEST(FindDeviations, AreKnownHoweverFarOffTheOriginIs) {
  const OccupancyGrid blank = make_grid(4, 4, 0.1, {5e5, 5.4e6, 1.0});
  const PreparedMap prepared(blank);
  const MapExtent extent{{5e5, 5.4e6}, 5.0, 20.0};
  const std::vector<AlignedMap> maps(2, {&prepared, {}, extent, {}});
  const std::vector<RelativePose> measured{measured_between(0, 1, {}, extent, extent, 0.1)};
  const auto deviations = find_deviations(maps, measured, 0);
  ASSERT_TRUE(deviations[1].has_value());
  EXPECT_NEAR(deviations[1]->position, 0.1 * std::sqrt(2.0), 1e-3);
}

TEST(FindDeviations, OfAKnownPoseAreThoseThatAreSaid) {
  const Blank blank;
  std::vector<AlignedMap> maps(2, {&blank.prepared, {}, blank.extent, {}});
  maps[0].known_pose = KnownPose{{}, 0.0, 0.0, true};
  maps[1].known_pose = KnownPose{{}, 0.3, 0.05, false};
  const auto deviations = find_deviations(maps, {}, 0);
  EXPECT_EQ(deviations[0]->position, 0.0);
  EXPECT_NEAR(deviations[1]->position, 0.3 * std::sqrt(2.0), 1e-6);
  EXPECT_NEAR(deviations[1]->theta, 0.05, 1e-6);
}

TEST(FindDeviations, AreKnownWhereOnePoseIsABillionTimesSurerThanAnother) {
  const Blank blank;
  for (const double sure : {1e-6, 1e3}) {
    const double unsure = sure == 1e3 ? 1e-6 : 1e3;
    std::vector<AlignedMap> maps(3, {&blank.prepared, {}, blank.extent, {}});
    maps[0].known_pose = KnownPose{{}, 0.0, 0.0, true};
    maps[1].known_pose = KnownPose{{}, sure, 1e-6, false};
    maps[2].known_pose = KnownPose{{}, unsure, 1e-6, false};
    const auto deviations = find_deviations(maps, {}, 0);
    ASSERT_TRUE(deviations[1] && deviations[2]) << sure;
    EXPECT_NEAR(deviations[1]->position / (sure * std::sqrt(2.0)), 1.0, 1e-6);
    EXPECT_NEAR(deviations[2]->position / (unsure * std::sqrt(2.0)), 1.0, 1e-6);
  }
}

// The solver would print that it found none.
TEST(FindDeviations, AreKnownHoweverSurelyPosesAreGivenAndNothingIsPrinted) {
  const Blank blank;
  std::vector<RelativePose> measured;
  std::vector<AlignedMap> maps(300, {&blank.prepared, {}, blank.extent, {}});
  for (std::size_t i = 1; i < maps.size(); ++i)
    measured.push_back(measured_between(i - 1, i, {}, blank.extent, blank.extent, 0.01));
  for (const double sd : {kMinDeviation, kMaxDeviation}) {
    for (const double sd_theta : {kMinDeviation, kMaxDeviation}) {
      for (const double sure : {kMinDeviation, kMaxDeviation}) {
        for (AlignedMap& map : maps) map.known_pose = KnownPose{{}, sd, sd_theta, false};
        maps[7].known_pose->sd_position = sure;
        testing::internal::CaptureStderr();
        const auto deviations = find_deviations(maps, measured, 0);
        EXPECT_EQ(testing::internal::GetCapturedStderr(), "") << sd << ' ' << sd_theta << ' ' << sure;
        EXPECT_TRUE(std::ranges::all_of(deviations, [](const auto& one) { return one.has_value(); }));
      }
    }
  }
}

TEST(Align, DrawsTheWallsOfTheMapsToEachOther) {
  const OccupancyGrid building = test::draw_building(1);
  const PreparedMap prepared(building);
  const Coverage coverage(prepared.known());
  const SE2 off{0.2, -0.15, 0.01};
  const std::vector<AlignedMap> maps(2, {&prepared, {}, coverage.extent(), {}});
  const std::vector<RelativePose> measured{
      measured_between(0, 1, off, coverage.extent(), coverage.extent(), 0.3)};
  const std::vector<SE2> poses = align(maps, measured);
  EXPECT_GT(displacement(coverage.extent(), off, {}), 0.15);
  EXPECT_LT(displacement(coverage.extent(), poses[1], {}), 0.05);
}

TEST(WallError, ItsDerivativesAreThoseOfItsResiduals) {
  const LikelihoodField fixed = make_likelihood_field(test::draw_building(1), 0.1);
  OccupancyGrid elsewhere = test::draw_building(1);
  elsewhere.origin = {3.0, -1.0, 0.7};
  const LikelihoodField moving = make_likelihood_field(elsewhere, 0.1);
  const Point2 fixed_middle{1.0, 2.0}, moving_middle{-3.0, 0.5};
  const WallError error(fixed, fixed_middle, moving, moving_middle, 2.0);
  const auto count = static_cast<std::size_t>(error.num_residuals());
  ASSERT_GT(count, 100u);
  double poses[2][3] = {{0.5, -0.25, 0.1}, {0.0, 0.0, 0.0}};
  // The moving map a little off where it belongs.
  const SE2 T = SE2{0.5, -0.25, 0.1} * SE2{-fixed_middle.x, -fixed_middle.y, 0.0} *
                inverse(elsewhere.origin) * SE2{0.13, 0.07, 0.01} *
                SE2{moving_middle.x, moving_middle.y, 0.0};
  poses[1][0] = T.x;
  poses[1][1] = T.y;
  poses[1][2] = T.theta;
  std::vector<double> residuals(count), jacobian_fixed(3 * count), jacobian_moving(3 * count);
  double* jacobians[2] = {jacobian_fixed.data(), jacobian_moving.data()};
  const double* both[2] = {poses[0], poses[1]};
  ASSERT_TRUE(error.Evaluate(both, residuals.data(), jacobians));
  constexpr double kStep = 1e-6;
  for (int block = 0; block < 2; ++block) {
    for (int k = 0; k < 3; ++k) {
      std::vector<double> above(count), below(count);
      const double here = poses[block][k];
      poses[block][k] = here + kStep;
      error.Evaluate(both, above.data(), nullptr);
      poses[block][k] = here - kStep;
      error.Evaluate(both, below.data(), nullptr);
      poses[block][k] = here;
      std::size_t differing = 0;  // a wall that crosses from cell to cell has none
      for (std::size_t i = 0; i < count; ++i) {
        const double numeric = (above[i] - below[i]) / (2.0 * kStep);
        if (std::abs(numeric - jacobians[block][3 * i + static_cast<std::size_t>(k)]) >
            1e-4 * (1.0 + std::abs(numeric)))
          ++differing;
      }
      EXPECT_LE(differing, count / 100) << block << ' ' << k;
    }
  }
}

TEST(WallError, IsTheFlattenedDistanceBetweenTheMiddlesOfCellsToo) {
  for (const bool is_upright : {false, true}) {
    OccupancyGrid map = make_grid(100, 100, 0.1, {}, Cell::free);
    for (int i = 10; i < 90; ++i) (is_upright ? map.at(50, i) : map.at(i, 50)) = Cell::occupied;
    const LikelihoodField field = make_likelihood_field(map, 0.1);
    const WallError error(field, {}, field, {}, 2.0);
    std::vector<double> residuals(static_cast<std::size_t>(error.num_residuals()));
    ASSERT_GT(residuals.size(), 50U);
    const auto residual_at = [&](double cells) {
      const double fixed[3] = {0.0, 0.0, 0.0};
      const double moving[3] = {is_upright ? 0.1 * cells : 0.0, is_upright ? 0.0 : 0.1 * cells, 0.0};
      const double* both[2] = {fixed, moving};
      EXPECT_TRUE(error.Evaluate(both, residuals.data(), nullptr));
      const auto [least, most] = std::minmax_element(residuals.begin(), residuals.end());
      EXPECT_NEAR(*least, *most, 1e-9) << cells;  // the wall is straight
      return *most;
    };
    EXPECT_NEAR(residual_at(0.0), 0.0, 1e-9);
    // r = k d / sqrt(d^2 + c^2): then 1 / r^2 is linear in 1 / d^2.
    const auto inverse_square = [&](double cells) { return 1.0 / (residual_at(cells) * residual_at(cells)); };
    const double slope = (inverse_square(1.0) - inverse_square(2.0)) / (1.0 - 0.25);
    EXPECT_GT(slope, 0.0);
    for (const double cells : {0.25, 0.5, 1.5, -0.5, -1.0, 3.0}) {
      const double expected = inverse_square(1.0) + slope * (1.0 / (cells * cells) - 1.0);
      EXPECT_NEAR(inverse_square(cells), expected, 1e-6 * expected) << cells;
    }
  }
}

TEST(Coverage, SharesAreThoseOfTheSmallerMap) {
  const OccupancyGrid building = test::draw_building(1);  // 18 m x 13 m
  const Coverage whole(building);
  const Coverage half(test::map_part(building, {0, 0, 9, 13}, {}));
  const auto share = [](const Coverage& a, const Coverage& b, const SE2& T_a_b) {
    return a.share_in_common(b, ManyPointsTransform(T_a_b));
  };
  EXPECT_NEAR(share(whole, half, {}), 1.0, 0.02);
  EXPECT_NEAR(share(half, whole, {}), 1.0, 0.02);
  EXPECT_NEAR(share(half, half, {4.5, 0.0, 0.0}), 0.5, 0.05);
  EXPECT_EQ(share(half, half, {100.0, 0.0, 0.0}), 0.0);
  for (double x = 0.0; x < 20.0; x += 0.5)  // the whole has nothing in common with the half from 18 m on
    EXPECT_EQ(share(whole, half, {x, 0.0, 0.0}) > 0.0, x < 18.0) << x;
  EXPECT_NEAR(half.extent().side, 13.0, 0.3);
  const std::vector<Point2> places = half.places_in_common(half, ManyPointsTransform({4.5, 0.0, 0.0}),
                                                           ManyPointsTransform({0.0, 100.0, 0.0}));
  EXPECT_FALSE(places.empty());
  for (const Point2& place : places) {
    EXPECT_GT(place.x, 4.0);
    EXPECT_GT(place.y, 99.0);
  }
}

}  // namespace
}  // namespace gridmerge
