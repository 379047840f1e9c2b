// SPDX-License-Identifier: Apache-2.0
#include "search/exhaustive.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "../similarity/random_grid.hpp"
#include "gridmerge/grid/execution.hpp"
#include "similarity/evidence.hpp"

namespace gridmerge {

using namespace internal;
namespace {

/// The score as the header defines it, from nothing but that definition.
class LiteralScore {
 public:
  LiteralScore(const LikelihoodField& fixed, const LikelihoodField& moving,
               const ExhaustiveSearchOptions& options)
      : fixed_(fixed),
        factor_(options.coarse_factor),
        walls_(draw_evenly(moving.walls, options.samples)),
        table_(evidence_table({options.sigma, options.outliers}, fixed.background)) {}

  int operator()(const SE2& T) const {
    int sum = 0;
    for (const WallPoint& wall : walls_) {
      // The nudge decides walls that fall on the edge of a coarse cell as exact arithmetic would.
      const Point2 p = T * wall.position;
      sum += coarse_value(static_cast<int>(std::floor(p.x / factor_ + 1e-9)),
                          static_cast<int>(std::floor(p.y / factor_ + 1e-9)));
    }
    return sum;
  }

 private:
  int coarse_value(int coarse_x, int coarse_y) const {
    float sum = 0.0F;
    bool inside = false;
    for (int y = coarse_y * factor_; y < (coarse_y + 1) * factor_; ++y) {
      for (int x = coarse_x * factor_; x < (coarse_x + 1) * factor_; ++x) {
        if (x < 0 || y < 0 || x >= fixed_.width || y >= fixed_.height) continue;
        inside = true;
        const int distance = fixed_.places[static_cast<std::size_t>(y) * fixed_.width + x].distance;
        if (distance != kUnseen) sum += table_[encounter(distance, kUnclearFacing)];
      }
    }
    if (!inside) return 0;
    return std::clamp(static_cast<int>(std::lround(6.0 * (static_cast<double>(sum) / (factor_ * factor_)))),
                      -15, 15);
  }

  const LikelihoodField& fixed_;
  int factor_;
  std::vector<WallPoint> walls_;
  std::array<float, kEncounters> table_;
};

ExhaustiveSearchOptions small_search() {
  ExhaustiveSearchOptions options;
  options.coarse_factor = 3;
  options.rotations = 7;  // no multiples of 90 degrees but 0: no ties between exact edges
  options.samples = 60;
  return options;
}

TEST(SearchAllPoses, EveryScoreIsTheLiteralOne) {
  for (unsigned seed = 0; seed < 6; ++seed) {
    const LikelihoodField fixed = make_likelihood_field(test::random_grid(seed, 33, 27), 0.1);
    const LikelihoodField moving = make_likelihood_field(test::random_grid(seed + 100, 24, 30), 0.1);
    const LiteralScore literal(fixed, moving, small_search());
    const auto found = search_all_poses(fixed, moving, small_search());
    ASSERT_FALSE(found.empty());
    for (const PoseCandidate& candidate : found)
      EXPECT_EQ(candidate.score, literal(candidate.T_fixed_moving)) << seed;
  }
}

TEST(SearchAllPoses, FindsTheBestOfAllPoses) {
  for (unsigned seed = 0; seed < 6; ++seed) {
    const LikelihoodField fixed = make_likelihood_field(test::random_grid(seed, 33, 27), 0.1);
    const LikelihoodField moving = make_likelihood_field(test::random_grid(seed + 100, 24, 30), 0.1);
    const ExhaustiveSearchOptions options = small_search();
    const LiteralScore literal(fixed, moving, options);
    const auto found = search_all_poses(fixed, moving, options);
    ASSERT_FALSE(found.empty());

    // Every rotation, and every shift of the lattice on which the best candidate's centre lies.
    const Point2 centre{0.5 * moving.width, 0.5 * moving.height};
    const Point2 best_centre = found.front().T_fixed_moving * centre;
    const int reach = (fixed.width + fixed.height + moving.width + moving.height) / options.coarse_factor;
    int best = 0;
    for (int rotation = 0; rotation < options.rotations; ++rotation) {
      const SE2 turn{0.0, 0.0, 2.0 * std::numbers::pi * rotation / options.rotations};
      const Point2 turned = turn * centre;
      for (int y = -reach; y <= reach; ++y) {
        for (int x = -reach; x <= reach; ++x) {
          best = std::max(best, literal({best_centre.x + x * options.coarse_factor - turned.x,
                                         best_centre.y + y * options.coarse_factor - turned.y, turn.theta}));
        }
      }
    }
    EXPECT_EQ(found.front().score, best) << seed;
  }
}

TEST(SearchAllPoses, DoesNotDependOnThreads) {
  const LikelihoodField fixed = make_likelihood_field(test::random_grid(1, 90, 70), 0.1);
  const LikelihoodField moving = make_likelihood_field(test::random_grid(2, 60, 80), 0.1);
  for (const std::size_t max_candidates : {100U, 1000000U}) {  // few: shifts are passed over; all: none is
    ExhaustiveSearchOptions options;
    options.max_candidates = max_candidates;
    std::vector<std::vector<PoseCandidate>> runs;
    for (const int threads : {1, 2, 4})
      with_threads(threads, [&] { runs.push_back(search_all_poses(fixed, moving, options)); });
    for (const auto& run : runs) {
      ASSERT_EQ(run.size(), runs[0].size());
      for (std::size_t i = 0; i < run.size(); ++i) {
        EXPECT_EQ(run[i].score, runs[0][i].score);
        EXPECT_EQ(run[i].T_fixed_moving, runs[0][i].T_fixed_moving);
      }
    }
  }
}

TEST(SearchAllPoses, CandidatesComeBestFirstAndNoneTwice) {
  const LikelihoodField fixed = make_likelihood_field(test::random_grid(1, 90, 70), 0.1);
  const LikelihoodField moving = make_likelihood_field(test::random_grid(2, 60, 80), 0.1);
  ExhaustiveSearchOptions options;
  options.max_candidates = 50;
  const auto found = search_all_poses(fixed, moving, options);
  ASSERT_EQ(found.size(), 50U);
  for (std::size_t i = 1; i < found.size(); ++i) {
    EXPECT_LE(found[i].score, found[i - 1].score);
    for (std::size_t j = 0; j < i; ++j) EXPECT_FALSE(found[i].T_fixed_moving == found[j].T_fixed_moving);
  }
}

// With so many candidates wanted that every shift has to be looked at, the best ones are the same: what is
// passed over otherwise cannot be among them.
TEST(SearchAllPoses, TheBestAreTheSameWhenAllAreLookedAt) {
  for (unsigned seed = 0; seed < 8; ++seed) {
    const int width = 60 + 25 * static_cast<int>(seed);
    const LikelihoodField fixed = make_likelihood_field(test::random_grid(seed, width, 70), 0.1);
    const LikelihoodField moving = make_likelihood_field(test::random_grid(seed + 100, 60, 80), 0.1);
    ExhaustiveSearchOptions options;
    options.coarse_factor = 2 + static_cast<int>(seed) % 3;
    options.rotations = 50;
    options.samples = seed == 7 ? 1 : 40 + 25 * seed;
    options.max_candidates = 1000000;
    const auto all = search_all_poses(fixed, moving, options);
    for (const std::size_t count : {1U, 10U, 60U, 200U}) {
      options.max_candidates = count;
      const auto found = search_all_poses(fixed, moving, options);
      ASSERT_EQ(found.size(), std::min(count, all.size())) << seed;
      for (std::size_t i = 0; i < found.size(); ++i) {
        ASSERT_EQ(found[i].score, all[i].score) << seed << " " << i;
        ASSERT_EQ(found[i].T_fixed_moving, all[i].T_fixed_moving) << seed << " " << i;
      }
    }
  }
}

TEST(SearchAllPoses, AMapWithoutWallsHasNoCandidates) {
  const LikelihoodField map = make_likelihood_field(test::random_grid(1, 30, 30), 0.1);
  const LikelihoodField empty = make_likelihood_field(make_grid(30, 30, 0.1, {}, Cell::free), 0.1);
  EXPECT_TRUE(search_all_poses(map, empty).empty());
  EXPECT_TRUE(search_all_poses(empty, empty).empty());
}

TEST(SearchAllPoses, RefusesOptionsThatMakeNoSense) {
  const LikelihoodField map = make_likelihood_field(test::random_grid(1, 30, 30), 0.1);
  const auto refused = [&](auto change) {
    ExhaustiveSearchOptions options;
    change(options);
    EXPECT_THROW(search_all_poses(map, map, options), std::invalid_argument);
  };
  refused([](auto& options) { options.coarse_factor = 0; });
  refused([](auto& options) { options.rotations = 0; });
  refused([](auto& options) { options.samples = kMaxSearchSamples + 1; });
  refused([](auto& options) { options.sigma = 0.0; });
  refused([](auto& options) { options.outliers = 1.0; });
  refused([](auto& options) { options.outliers = std::nan(""); });
  const LikelihoodField other = make_likelihood_field(test::random_grid(1, 30, 30), 0.2);
  EXPECT_THROW(search_all_poses(map, other), std::invalid_argument);
}

}  // namespace
}  // namespace gridmerge
