// SPDX-License-Identifier: Apache-2.0
#include "search/thorough.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <map>
#include <numbers>
#include <utility>
#include <vector>

#include "../similarity/random_grid.hpp"
#include "gridmerge/grid/execution.hpp"
#include "similarity/evidence.hpp"
#include "support/building.hpp"
#include "support/effort.hpp"

namespace gridmerge {

using namespace internal;
namespace {

/// The score as the header defines it, from nothing but that definition: cell by cell and sample by sample.
class LiteralScore {
 public:
  LiteralScore(const LikelihoodField& fixed, const LikelihoodField& moving,
               const ThoroughSearchOptions& options)
      : fixed_(fixed),
        moving_(moving),
        factor_(options.coarse_factor),
        walls_(draw_evenly(moving.walls, options.samples)),
        table_(evidence_table({options.sigma, options.outliers}, fixed.background)) {}

  /// Of the pose (T), which the search gave, or of a neighbour of it by so many shifts.
  double operator()(const SE2& T) const {
    const int steps = steps_of_turn(T.theta);
    int sum = 0, seen = 0, looked_up = 0;
    for (std::size_t i = 0; i < walls_.size(); ++i) {
      const Point2 p = T * walls_[i].position;
      const int x = static_cast<int>(std::floor(p.x / factor_ + 1e-9));
      const int y = static_cast<int>(std::floor(p.y / factor_ + 1e-9));
      sum += coarse_value(x, y, turned(walls_[i].facing, steps));
      if (i % 4 != 0) continue;
      ++looked_up;
      seen += seen_share(x - shift_parity(T, 0), y - shift_parity(T, 1));
    }
    const double n = static_cast<double>(walls_.size()) / looked_up * seen / 15.0;
    if (n < kMinSeenSamples) return 0.0;
    return 256.0 * (sum / 6.0 + 0.37 * n) / (0.48 * std::pow(n, 0.75));
  }

 private:
  /// What is seen is told for pairs of shifts: 1 at the second shift of a pair.
  int shift_parity(const SE2& T, int axis) const {
    const Point2 centre{0.5 * moving_.width, 0.5 * moving_.height};
    const double angle = T.theta;
    const auto coarse = [&](double cells) { return static_cast<int>(std::ceil(cells / factor_)); };
    const int box = coarse(std::hypot(moving_.width, moving_.height)) + 2;
    const auto known = first_shift_.find({T.theta, axis});
    if (known != first_shift_.end()) return (shift_of(T * centre, axis, box) - known->second) % 2;
    // Where the walls fall in the box, and the first shift at which 25 of them (or all) can meet the map.
    std::vector<int> places;
    for (const WallPoint& wall : walls_) {
      const double x = wall.position.x - centre.x, y = wall.position.y - centre.y;
      const double turned =
          axis == 0 ? std::cos(angle) * x - std::sin(angle) * y : std::sin(angle) * x + std::cos(angle) * y;
      places.push_back(static_cast<int>(std::floor(turned / factor_ + 0.5 * box)));
    }
    std::sort(places.begin(), places.end());
    const std::size_t least = std::min<std::size_t>(places.size(), 25);
    first_shift_[{T.theta, axis}] = box - places[places.size() - least] - 1;
    return shift_parity(T, axis);
  }

  int shift_of(const Point2& middle, int axis, int box) const {
    return static_cast<int>(std::lround((axis == 0 ? middle.x : middle.y) / factor_ + 0.5 * box));
  }

  template <typename Value>
  void for_cells(int coarse_x, int coarse_y, Value value) const {
    for (int y = coarse_y * factor_; y < (coarse_y + 1) * factor_; ++y) {
      for (int x = coarse_x * factor_; x < (coarse_x + 1) * factor_; ++x) {
        if (x < 0 || y < 0 || x >= fixed_.width || y >= fixed_.height) continue;
        const Place& place = fixed_.places[static_cast<std::size_t>(y) * fixed_.width + x];
        if (place.distance != kUnseen) value(place);
      }
    }
  }

  int coarse_value(int coarse_x, int coarse_y, std::uint8_t facing) const {
    const int first = facing / 2 * 2, last = std::min(first + 1, kFacingCodes - 1);
    double sum = 0.0;
    for_cells(coarse_x, coarse_y, [&](const Place& place) {
      for (int code = first; code <= last; ++code) {
        const int met = facing_class(static_cast<std::uint8_t>(code), place.facing);
        sum += static_cast<double>(table_[static_cast<std::size_t>(encounter(place.distance, met))]) /
               (last - first + 1);
      }
    });
    return std::clamp(static_cast<int>(std::lround(6.0 * sum / (factor_ * factor_))), -15, 15);
  }

  /// In fifteenths, the mean of four cells.
  int seen_share(int coarse_x, int coarse_y) const {
    int count = 0;
    for (int i = 0; i < 4; ++i) for_cells(coarse_x + i % 2, coarse_y + i / 2, [&](const Place&) { ++count; });
    const int all = 4 * factor_ * factor_;
    return (15 * count + all / 2) / all;
  }

  const LikelihoodField& fixed_;
  const LikelihoodField& moving_;
  int factor_;
  std::vector<WallPoint> walls_;
  std::array<float, kEncounters> table_;
  mutable std::map<std::pair<double, int>, int> first_shift_;  // by angle and axis
};

ThoroughSearchOptions small_search() {
  ThoroughSearchOptions options;
  options.coarse_factor = 3;
  options.rotations = 7;  // no multiples of 90 degrees but 0: no ties between exact edges
  options.samples = 120;
  options.max_candidates = 100;
  return options;
}

struct RandomPair {
  explicit RandomPair(unsigned seed)
      : fixed(make_likelihood_field(test::random_grid(seed, 53, 47), 0.1)),
        moving(make_likelihood_field(test::random_grid(seed + 100, 44, 50), 0.1)) {}
  LikelihoodField fixed;
  LikelihoodField moving;
};

TEST(SearchThoroughly, EveryScoreIsTheLiteralOne) {
  for (unsigned seed = 0; seed < 6; ++seed) {
    const RandomPair pair(seed);
    const LiteralScore literal(pair.fixed, pair.moving, small_search());
    const auto found = search_thoroughly(pair.fixed, pair.moving, small_search());
    ASSERT_FALSE(found.empty());
    // A cell's evidence is rounded to sixths of a nat, and sums of floats may round the other way.
    for (const PoseCandidate& candidate : found)
      EXPECT_NEAR(candidate.score, literal(candidate.T_fixed_moving), 16.0) << seed;
  }
}

TEST(SearchThoroughly, FindsTheBestOfAllPoses) {
  for (unsigned seed = 0; seed < test::repeats(2U, 1U); ++seed) {
    const RandomPair pair(seed);
    const ThoroughSearchOptions options = small_search();
    const LiteralScore literal(pair.fixed, pair.moving, options);
    const auto found = search_thoroughly(pair.fixed, pair.moving, options);
    ASSERT_FALSE(found.empty());
    const Point2 centre{0.5 * pair.moving.width, 0.5 * pair.moving.height};
    const Point2 best_centre = found.front().T_fixed_moving * centre;
    const int reach = 100 / options.coarse_factor;  // the maps' middles are nearer where 25 walls can meet
    double best = 0.0;
    for (int rotation = 0; rotation < options.rotations; ++rotation) {
      const SE2 turn{0.0, 0.0, normalize_angle(2.0 * std::numbers::pi * rotation / options.rotations)};
      const Point2 turned = turn * centre;
      for (int y = -reach; y <= reach; ++y) {
        for (int x = -reach; x <= reach; ++x) {
          best = std::max(best, literal({best_centre.x + x * options.coarse_factor - turned.x,
                                         best_centre.y + y * options.coarse_factor - turned.y, turn.theta}));
        }
      }
    }
    EXPECT_NEAR(found.front().score, best, 16.0) << seed;
  }
}

TEST(SearchThoroughly, DoesNotDependOnThreads) {
  const LikelihoodField fixed = make_likelihood_field(test::random_grid(1, 90, 70), 0.1);
  const LikelihoodField moving = make_likelihood_field(test::random_grid(2, 60, 80), 0.1);
  for (const std::size_t max_candidates : {50U, 1000000U}) {  // few: shifts are passed over; all: none is
    ThoroughSearchOptions options;
    options.max_candidates = max_candidates;
    std::vector<std::vector<PoseCandidate>> runs;
    for (const int threads : {1, 2, 4})
      with_threads(threads, [&] { runs.push_back(search_thoroughly(fixed, moving, options)); });
    for (const auto& run : runs) {
      ASSERT_EQ(run.size(), runs[0].size());
      for (std::size_t i = 0; i < run.size(); ++i) {
        EXPECT_EQ(run[i].score, runs[0][i].score);
        EXPECT_EQ(run[i].T_fixed_moving, runs[0][i].T_fixed_moving);
      }
    }
  }
}

TEST(SearchThoroughly, TheBestAreTheSameWhenAllAreLookedAt) {
  for (unsigned seed = 0; seed < 6; ++seed) {
    const LikelihoodField fixed =
        make_likelihood_field(test::random_grid(seed, 60 + 25 * static_cast<int>(seed), 70), 0.1);
    const LikelihoodField moving = make_likelihood_field(test::random_grid(seed + 100, 60, 80), 0.1);
    ThoroughSearchOptions options;
    options.coarse_factor = 2 + static_cast<int>(seed) % 3;
    options.rotations = 50;
    options.samples = 60 + 90 * seed;
    options.max_candidates = 1000000;
    const auto all = search_thoroughly(fixed, moving, options);
    for (const std::size_t count : {1U, 10U, 60U, 200U}) {
      options.max_candidates = count;
      const auto found = search_thoroughly(fixed, moving, options);
      ASSERT_EQ(found.size(), std::min(count, all.size())) << seed;
      for (std::size_t i = 0; i < found.size(); ++i) {
        ASSERT_EQ(found[i].score, all[i].score) << seed << " " << i;
        ASSERT_EQ(found[i].T_fixed_moving, all[i].T_fixed_moving) << seed << " " << i;
      }
    }
  }
}

/// Where the truth stands among the candidates of two pieces of a building that share a strip of it.
std::size_t rank_of_truth(const std::vector<PoseCandidate>& candidates, const SE2& T_true) {
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    const SE2& T = candidates[i].T_fixed_moving;
    if (std::hypot(T.x - T_true.x, T.y - T_true.y) < 12.0 &&
        std::abs(normalize_angle(T.theta - T_true.theta)) < 0.1)
      return i;
  }
  return candidates.size();
}

TEST(SearchThoroughly, LittleOverlapStandsBeforeMuchByChance) {
  const OccupancyGrid building = test::draw_building(1);
  const OccupancyGrid left = test::map_part(building, {0, 0, 7.5, 13}, {});
  const OccupancyGrid right = test::map_part(building, {6, 0, 18, 13}, {});
  const LikelihoodField fixed = make_likelihood_field(right, 0.05),
                        moving = make_likelihood_field(left, 0.05);
  const SE2 T_metres = inverse(fixed.T_map_grid) * moving.T_map_grid;
  const SE2 T_true{T_metres.x / 0.05, T_metres.y / 0.05, T_metres.theta};
  const std::size_t thorough = rank_of_truth(search_thoroughly(fixed, moving), T_true);
  const std::size_t quick = rank_of_truth(search_all_poses(fixed, moving), T_true);
  EXPECT_LT(thorough, 20U);
  EXPECT_LT(thorough, quick);
}

TEST(SearchThoroughly, AMapWithoutWallsHasNoCandidates) {
  const LikelihoodField map = make_likelihood_field(test::random_grid(1, 30, 30), 0.1);
  const LikelihoodField empty = make_likelihood_field(make_grid(30, 30, 0.1, {}, Cell::free), 0.1);
  EXPECT_TRUE(search_thoroughly(map, empty).empty());
  EXPECT_TRUE(search_thoroughly(empty, empty).empty());
  EXPECT_TRUE(search_thoroughly(empty, map).empty());
}

// Walls so few and so far apart that no shift has even half of them on the fixed map.
TEST(SearchThoroughly, FewWallsFarApartAreNoError) {
  std::mt19937 random(1);
  for (int run = 0; run < 40; ++run) {
    OccupancyGrid small = make_grid(60, 60, 0.05, {}, Cell::free);
    for (int i = 0; i < 60; ++i) small.at(i, 0) = small.at(0, i) = Cell::occupied;
    const int length = 200 + static_cast<int>(random() % 200), walls = 1 + run;
    OccupancyGrid hall = make_grid(length, 20, 0.05, {}, Cell::free);
    for (int i = 0; i < walls; ++i)
      hall.at(static_cast<int>(random() % static_cast<unsigned>(length)), static_cast<int>(random() % 20)) =
          Cell::occupied;
    const LikelihoodField a = make_likelihood_field(small, 0.05), b = make_likelihood_field(hall, 0.05);
    for (const PoseCandidate& candidate : search_thoroughly(a, b))
      EXPECT_TRUE(std::isfinite(candidate.score));
    for (const PoseCandidate& candidate : search_thoroughly(b, a))
      EXPECT_TRUE(std::isfinite(candidate.score));
  }
}

TEST(SearchThoroughly, RefusesOptionsThatMakeNoSense) {
  const LikelihoodField map = make_likelihood_field(test::random_grid(1, 30, 30), 0.1);
  const auto refused = [&](auto change) {
    ThoroughSearchOptions options;
    change(options);
    EXPECT_THROW(search_thoroughly(map, map, options), std::invalid_argument);
  };
  refused([](auto& options) { options.coarse_factor = 0; });
  refused([](auto& options) { options.rotations = 0; });
  refused([](auto& options) { options.samples = kMaxThoroughSamples + 1; });
  refused([](auto& options) { options.sigma = 0.0; });
  refused([](auto& options) { options.outliers = 1.0; });
  refused([](auto& options) { options.sigma = -1.0; });
  refused([](auto& options) { options.outliers = 0.0; });
  ThoroughSearchOptions least;
  least.coarse_factor = least.rotations = 1;
  least.samples = kMaxThoroughSamples;
  EXPECT_FALSE(search_thoroughly(map, map, least).empty());
  const LikelihoodField other = make_likelihood_field(test::random_grid(1, 30, 30), 0.2);
  EXPECT_THROW(search_thoroughly(map, other), std::invalid_argument);
}

}  // namespace
}  // namespace gridmerge
