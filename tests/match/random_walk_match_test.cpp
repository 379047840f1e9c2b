// SPDX-License-Identifier: Apache-2.0
#include "gridmerge/match/random_walk_match.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "gridmerge/grid/resample.hpp"
#include "support/building.hpp"
#include "support/effort.hpp"

namespace gridmerge {
namespace {

const OccupancyGrid& building() {
  static const OccupancyGrid map = downsample(test::draw_building(3), 2);
  return map;
}

const OccupancyGrid& other_building() {
  static const OccupancyGrid map = downsample(test::draw_building(4), 2);
  return map;
}

RandomWalkMatchOptions quick() {
  RandomWalkMatchOptions options;
  options.walk.patience = 400;
  options.accept_acceptance_index = 0.95;
  return options;
}

TEST(MatchByRandomWalk, FindsAnEasyPairFromNineOfTenSeeds) {
  const SE2 T_moving_fixed{4.0, -2.0, 0.8};
  const OccupancyGrid moving = transform_grid(building(), T_moving_fixed, building().resolution);
  int right = 0;
  const int seeds = test::repeats(10, 2);
  for (int seed = 1; seed <= seeds; ++seed) {
    RandomWalkMatchOptions options = quick();
    options.walk.patience = 2000;
    options.walk.seed = static_cast<std::uint64_t>(seed);
    const MatchResult result = match_by_random_walk(building(), moving, options);
    const Point2 middle{9.0, 6.5};
    const Point2 back = result.T_fixed_moving * (T_moving_fixed * middle);
    right += std::hypot(back.x - middle.x, back.y - middle.y) < 0.3 ? 1 : 0;
  }
  EXPECT_GE(10 * right, 9 * seeds);
}

TEST(MatchByRandomWalk, AcceptsByTheAcceptanceIndexAlone) {
  RandomWalkMatchOptions options = quick();
  const MatchResult same = match_by_random_walk(building(), building(), options);
  EXPECT_EQ(same.verdict, Verdict::accepted);
  EXPECT_EQ(same.acceptance_index, 1.0);  // the centres on each other are a start pose
  EXPECT_EQ(same.probability, 1.0);
  EXPECT_NEAR(same.overlap, 1.0, 1e-12);

  const MatchResult other = match_by_random_walk(building(), other_building(), options);
  EXPECT_EQ(other.verdict, Verdict::refused);
  EXPECT_EQ(other.probability, other.acceptance_index);
  options.accept_acceptance_index = other.acceptance_index;
  EXPECT_EQ(match_by_random_walk(building(), other_building(), options).verdict, Verdict::accepted);
}

TEST(MatchByRandomWalk, AHandfulOfCellsIsNotEnough) {
  OccupancyGrid corner = make_grid(5, 3, 0.2, {}, Cell::free);
  for (int column = 0; column < 5; ++column) corner.at(column, 0) = Cell::occupied;
  RandomWalkMatchOptions options = quick();
  options.restarts = 8;
  const MatchResult found = match_by_random_walk(building(), corner, options);
  EXPECT_GE(found.acceptance_index, 0.95);
  EXPECT_EQ(found.verdict, Verdict::refused);
  const auto common = found.agreement + found.disagreement;
  options.least_common_cells = common;
  EXPECT_EQ(match_by_random_walk(building(), corner, options).verdict, Verdict::accepted);
  options.least_common_cells = common + 1;
  EXPECT_EQ(match_by_random_walk(building(), corner, options).reason, Reason::too_little_overlap);
}

/// Cells that differ are common ones, too.
TEST(MatchByRandomWalk, CellsThatDifferAreComparedAsWell) {
  RandomWalkMatchOptions options = quick();
  options.accept_acceptance_index = 0.0;
  const MatchResult found = match_by_random_walk(building(), other_building(), options);
  ASSERT_GT(found.disagreement, 0);
  options.least_common_cells = found.agreement + found.disagreement;
  EXPECT_EQ(match_by_random_walk(building(), other_building(), options).verdict, Verdict::accepted);
  options.least_common_cells += 1;
  EXPECT_EQ(match_by_random_walk(building(), other_building(), options).reason, Reason::too_little_overlap);
}

TEST(MatchByRandomWalk, TheFirstWalkHasTheSeedItselfAndTheOthersSeedsOfTheirOwn) {
  RandomWalkMatchOptions options = quick();
  options.walk.patience = 60;
  options.walk.seed = 7;
  options.start_pose = SE2{1.0, -0.5, 0.3};
  options.restarts = 3;
  std::vector<SE2> ends;
  options.on_walk = [&](int, double, const RandomWalkResult& walk) { ends.push_back(walk.T_fixed_moving); };
  match_by_random_walk(building(), other_building(), options);
  ASSERT_EQ(ends.size(), 3U);
  RandomWalkOptions alone = options.walk;
  alone.c_lock = options.c_locks.front();
  EXPECT_EQ(ends[0], random_walk(building(), other_building(), *options.start_pose, alone).T_fixed_moving);
  options.walk.seed = 8;
  match_by_random_walk(building(), other_building(), options);
  for (std::size_t i = 0; i < ends.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) EXPECT_NE(ends[i], ends[j]) << i << " " << j;
}

TEST(MatchByRandomWalk, ListsDistinctHypothesesAndNoMoreThanAskedFor) {
  RandomWalkMatchOptions options = quick();
  options.walk.patience = 100;
  options.restarts = 12;
  const MatchResult all = match_by_random_walk(building(), other_building(), options);
  ASSERT_GT(all.hypotheses.size(), 1U);
  const Point2 middle{9.0, 6.5};
  for (std::size_t i = 0; i < all.hypotheses.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      const SE2& a = all.hypotheses[i].T_fixed_moving;
      const SE2& b = all.hypotheses[k].T_fixed_moving;
      const Point2 at_a = a * middle, at_b = b * middle;
      EXPECT_TRUE(std::hypot(at_a.x - at_b.x, at_a.y - at_b.y) > 0.05 ||
                  std::abs(normalize_angle(a.theta - b.theta)) > 0.01);
    }
  }
  options.max_hypotheses = 1;
  EXPECT_EQ(match_by_random_walk(building(), other_building(), options).hypotheses.size(), 1U);
}

TEST(MatchByRandomWalk, KeepsTheBestOfItsWalks) {
  RandomWalkMatchOptions options = quick();
  options.restarts = 4;
  options.c_locks = {0.0, 0.01};
  std::vector<double> c_locks;
  double best = 0.0;
  options.on_walk = [&](int walk, double c_lock, const RandomWalkResult& result) {
    EXPECT_EQ(walk, static_cast<int>(c_locks.size()));
    c_locks.push_back(c_lock);
    best = std::max(best, result.similarity.acceptance_index());
  };
  const MatchResult result = match_by_random_walk(building(), other_building(), options);
  EXPECT_EQ(c_locks, (std::vector<double>{0.0, 0.01, 0.0, 0.01}));
  EXPECT_EQ(result.acceptance_index, best);
  for (std::size_t i = 1; i < result.hypotheses.size(); ++i)
    EXPECT_LE(result.hypotheses[i].score, result.hypotheses[i - 1].score);
}

/// One walk for each lock term from the best start, then one for each from the next one.
TEST(MatchByRandomWalk, EachLockTermHasItsWalkFromEachStart) {
  const auto last_of_four = [&](std::size_t lock_terms) {
    RandomWalkMatchOptions options = quick();
    options.walk.patience = 30;
    options.walk.seed = 7;
    options.restarts = 4;
    options.c_locks.assign(lock_terms, 0.01);
    SE2 last;
    options.on_walk = [&](int, double, const RandomWalkResult& walk) { last = walk.T_fixed_moving; };
    match_by_random_walk(building(), other_building(), options);
    return last;
  };
  EXPECT_EQ(last_of_four(2), last_of_four(3)) << "from the second start";
  EXPECT_NE(last_of_four(2), last_of_four(4)) << "from the first one";
  EXPECT_NE(last_of_four(2), last_of_four(1)) << "from the fourth one";
}

TEST(MatchByRandomWalk, MapsWithNothingKnownHaveNoHypothesis) {
  const OccupancyGrid unknown = make_grid(30, 20, 0.1);
  EXPECT_TRUE(match_by_random_walk(building(), unknown, quick()).hypotheses.empty());
  EXPECT_EQ(match_by_random_walk(unknown, unknown, quick()).verdict, Verdict::refused);
}

TEST(MatchByRandomWalk, RefusesInvalidMapsWhateverTheyKnow) {
  for (const OccupancyGrid& map : {building(), make_grid(30, 20, 0.1)}) {
    OccupancyGrid invalid = map;
    invalid.resolution = 0.0;
    EXPECT_THROW(match_by_random_walk(invalid, map, quick()), std::invalid_argument);
    EXPECT_THROW(match_by_random_walk(map, invalid, quick()), std::invalid_argument);
  }
}

TEST(MatchByRandomWalk, RefusesOptionsThatMakeNoSense) {
  const auto refused = [&](auto change) {
    RandomWalkMatchOptions options = quick();
    change(options);
    EXPECT_THROW(match_by_random_walk(building(), building(), options), std::invalid_argument);
  };
  refused([](auto& o) { o.restarts = 0; });
  refused([](auto& o) { o.threads = -1; });
  refused([](auto& o) { o.least_common_cells = -1; });
  refused([](auto& o) { o.c_locks.clear(); });
  refused([](auto& o) { o.c_locks = {0.0, -1.0}; });
  refused([](auto& o) { o.c_locks = {std::nan("")}; });
  refused([](auto& o) { o.accept_acceptance_index = 1.5; });
  refused([](auto& o) { o.accept_acceptance_index = std::nan(""); });
  refused([](auto& o) { o.walk.patience = 0; });
  RandomWalkMatchOptions least = quick();
  least.threads = least.restarts = 1;
  least.least_common_cells = 0;
  least.accept_acceptance_index = 0.0;
  least.c_locks = {0.0};
  EXPECT_NO_THROW(validate(least));
  least.accept_acceptance_index = 1.0;
  EXPECT_NO_THROW(validate(least));
}

}  // namespace
}  // namespace gridmerge
