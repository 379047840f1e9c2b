// SPDX-License-Identifier: Apache-2.0
#include "gridmerge/similarity/image_similarity.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <utility>

#include "literal_similarity.hpp"
#include "support/effort.hpp"

namespace gridmerge {
namespace {

/// Every class in any share, none of it included.
OccupancyGrid random_map(std::mt19937& random, int width, int height, double resolution = 0.1) {
  OccupancyGrid map = make_grid(width, height, resolution, {1.5, -2.0, 0.0});
  const auto free = random() % 101;
  const auto occupied = random() % (101 - free);
  for (Cell& cell : map.cells) {
    const auto at = random() % 100;
    cell = at < free ? Cell::free : at < free + occupied ? Cell::occupied : Cell::unknown;
  }
  return map;
}

double uniform(std::mt19937& random, double from, double to) {
  return from + (to - from) * static_cast<double>(random()) / static_cast<double>(std::mt19937::max());
}

/// The fixed map's lattice, continued by `rim` cells on every side.
OccupancyGrid continued(const OccupancyGrid& map, int rim) {
  OccupancyGrid canvas = make_grid(map.width + 2 * rim, map.height + 2 * rim, map.resolution, map.origin);
  const Point2 corner = map.origin * Point2{-rim * map.resolution, -rim * map.resolution};
  canvas.origin.x = corner.x;
  canvas.origin.y = corner.y;
  for (int row = 0; row < map.height; ++row) {
    for (int column = 0; column < map.width; ++column)
      canvas.at(column + rim, row + rim) = map.at(column, row);
  }
  return canvas;
}

void expect_equal(const DirectedDistance& found, const literal::Directed& expected) {
  EXPECT_EQ(found.sum, expected.sum);
  EXPECT_EQ(found.count, expected.count);
}

void expect_literal(const OccupancyGrid& fixed, const OccupancyGrid& moving, const SE2& T, int rim) {
  const OccupancyGrid canvas = continued(fixed, rim);
  const literal::Similarity expected = literal::measure(canvas, literal::draw_on(canvas, moving, T));
  const ImageSimilarity found = measure_similarity(fixed, moving, T);
  expect_equal(found.fixed_to_moving_free, expected.fixed_to_moving_free);
  expect_equal(found.moving_to_fixed_free, expected.moving_to_fixed_free);
  expect_equal(found.fixed_to_moving_occupied, expected.fixed_to_moving_occupied);
  expect_equal(found.moving_to_fixed_occupied, expected.moving_to_fixed_occupied);
  EXPECT_EQ(found.agreement, expected.agreement);
  EXPECT_EQ(found.disagreement, expected.disagreement);
}

TEST(DistanceMap, EqualsTheTwoPassesOfThePaper) {
  std::mt19937 random(1);
  for (int run = 0; run < 200; ++run) {
    const OccupancyGrid map =
        random_map(random, 1 + static_cast<int>(random() % 70), 1 + static_cast<int>(random() % 70));
    for (const Cell value : {Cell::unknown, Cell::free, Cell::occupied}) {
      const DistanceMap found = make_distance_map(map, value);
      const std::vector<int> expected = literal::distance_map(map, value);
      ASSERT_EQ(found.distances.size(), expected.size());
      for (std::size_t i = 0; i < expected.size(); ++i)
        ASSERT_EQ(found.distances[i], expected[i] >= literal::kInfinite ? kNoDistance : expected[i])
            << run << " " << i;
    }
  }
}

TEST(DistanceMap, ThePassesEndInIt) {
  std::mt19937 random(2);
  for (int run = 0; run < 50; ++run) {
    const OccupancyGrid map =
        random_map(random, 1 + static_cast<int>(random() % 40), 1 + static_cast<int>(random() % 40));
    for (const Cell value : {Cell::unknown, Cell::free, Cell::occupied})
      EXPECT_EQ(trace_distance_map(map, value).backward.distances, make_distance_map(map, value).distances);
  }
}

TEST(DistanceMap, ThePassesGoFromCornerToCorner) {
  OccupancyGrid map = make_grid(3, 3, 1.0);
  map.at(1, 1) = Cell::occupied;
  const DistanceMapPasses passes = trace_distance_map(map, Cell::occupied);
  constexpr std::uint16_t kNone = kNoDistance;
  // Row 0, the lower one, first.
  EXPECT_EQ(passes.start.distances,
            (std::vector<std::uint16_t>{kNone, kNone, kNone, kNone, 0, kNone, kNone, kNone, kNone}));
  EXPECT_EQ(passes.forward.distances,
            (std::vector<std::uint16_t>{kNone, 1, 2, kNone, 0, 1, kNone, kNone, kNone}));
  EXPECT_EQ(passes.backward.distances, (std::vector<std::uint16_t>{2, 1, 2, 1, 0, 1, 2, 1, 2}));
}

TEST(DistanceMap, CrossesTheLargestMaps) {
  OccupancyGrid map = make_grid(kMaxDistanceMapSides - 1, 1, 0.05, {}, Cell::free);
  map.at(0, 0) = Cell::occupied;
  EXPECT_EQ(make_distance_map(map, Cell::occupied).at(map.width - 1, 0), map.width - 1);
  EXPECT_THROW(make_distance_map(make_grid(kMaxDistanceMapSides, 1, 0.05), Cell::free),
               std::invalid_argument);
}

TEST(ImageSimilarity, EqualsTheLiteralOneUnderAnyTransform) {
  std::mt19937 random(2);
  for (int run = 0; run < test::repeats(200, 60); ++run) {
    SCOPED_TRACE(run);
    const OccupancyGrid fixed =
        random_map(random, 1 + static_cast<int>(random() % 50), 1 + static_cast<int>(random() % 50));
    const double resolution = std::array{0.1, 0.07, 0.23}[static_cast<std::size_t>(run % 3)];
    OccupancyGrid moving = random_map(random, 1 + static_cast<int>(random() % 50),
                                      1 + static_cast<int>(random() % 50), resolution);
    moving.origin.theta = run % 5 == 0 ? 0.7 : 0.0;
    const double reach = run % 4 == 0 ? 8.0 : 2.0;  // [m]: apart, or on each other
    const SE2 T{uniform(random, -reach, reach), uniform(random, -reach, reach),
                uniform(random, -std::numbers::pi, std::numbers::pi)};
    expect_literal(fixed, moving, T, 240);
    expect_literal(moving, fixed, inverse(T), 240);
    const OccupancyGrid drawn = literal::draw_on(fixed, moving, T);
    std::int64_t equal = 0;
    for (std::size_t i = 0; i < drawn.cells.size(); ++i) equal += drawn.cells[i] == fixed.cells[i];
    EXPECT_EQ(count_equal_cells(fixed, moving, T), equal);
    if (HasFailure()) break;
  }
}

TEST(ImageSimilarity, EqualsTheLiteralOneOnMapsLargerThanAnyBlockOfTheKernels) {
  std::mt19937 random(8);
  for (const double resolution : {0.1, 0.073}) {
    OccupancyGrid fixed = random_map(random, 430, 310);
    OccupancyGrid moving = random_map(random, 360, 405, resolution);
    for (OccupancyGrid* map :
         {&fixed, &moving}) {  // nearly all of one class, so that sums and counts are large
      for (std::size_t i = 0; i < map->cells.size(); ++i)
        map->cells[i] = i % 997 == 0 ? Cell::occupied : Cell::free;
    }
    expect_literal(fixed, moving, {3.0, -7.0, 0.6}, 300);
    expect_literal(fixed, moving, {31.0, 12.0, -2.0}, 500);
  }
}

TEST(ImageSimilarity, FewerUndefinedDistancesAreBetterWhateverDelta) {
  ImageSimilarity whole;
  whole.fixed_to_moving_free = whole.moving_to_fixed_free = {100, 1};
  whole.fixed_to_moving_occupied = whole.moving_to_fixed_occupied = {100, 1};
  const ImageSimilarity lost;
  EXPECT_TRUE(is_better(whole, lost, 0.0));
  EXPECT_FALSE(is_better(lost, whole, 0.0));
  ImageSimilarity better = whole;
  better.agreement = 1;
  EXPECT_TRUE(is_better(better, whole, 1.0));
  EXPECT_FALSE(is_better(better, whole, 0.0));
}

TEST(ImageSimilarity, EqualsTheLiteralOneForPlainShiftsAndQuarterTurns) {
  std::mt19937 random(3);
  for (int run = 0; run < 60; ++run) {
    SCOPED_TRACE(run);
    const OccupancyGrid fixed = random_map(random, 1 + run % 40, 1 + run * 7 % 40);
    const OccupancyGrid moving = random_map(random, 1 + run * 3 % 40, 1 + run * 5 % 40);
    // About the corner of cell (0, 0), so that centres meet centres.
    const SE2 about = fixed.origin;
    const SE2 T = about * SE2{0.1 * (run % 11 - 5), 0.1 * (run % 7 - 3), std::numbers::pi / 2 * (run % 4)} *
                  inverse(about);
    expect_literal(fixed, moving, T, 120);
  }
}

TEST(ImageSimilarity, PsiIsTheSumOfTheFourMeans) {
  OccupancyGrid m1 = make_grid(5, 1, 1.0);  // O.f..
  m1.at(0, 0) = Cell::occupied;
  m1.at(2, 0) = Cell::free;
  OccupancyGrid m2 = make_grid(5, 1, 1.0);  // f.O.O
  m2.at(0, 0) = Cell::free;
  m2.at(2, 0) = m2.at(4, 0) = Cell::occupied;
  const ImageSimilarity similarity = measure_similarity(m1, m2, {});
  EXPECT_EQ(similarity.fixed_to_moving_occupied.mean(), 2.0);
  EXPECT_EQ(similarity.moving_to_fixed_occupied.mean(), 3.0);
  EXPECT_EQ(similarity.fixed_to_moving_free.mean(), 2.0);
  EXPECT_EQ(similarity.moving_to_fixed_free.mean(), 2.0);
  EXPECT_EQ(similarity.psi(), 9.0);
  EXPECT_EQ(similarity.agreement, 0);
  EXPECT_EQ(similarity.disagreement, 2);
  EXPECT_EQ(similarity.delta(0.0), 9.0);
  EXPECT_EQ(similarity.delta(7.5), 24.0);
  EXPECT_EQ(similarity.undefined_terms(), 0);
}

TEST(ImageSimilarity, IsPerfectOfAMapWithItself) {
  std::mt19937 random(4);
  for (int run = 0; run < 20; ++run) {
    OccupancyGrid map = random_map(random, 30, 20);
    map.cells.front() = Cell::free;
    const ImageSimilarity similarity = measure_similarity(map, map, {});
    EXPECT_EQ(similarity.psi(), 0.0);
    EXPECT_EQ(similarity.acceptance_index(), 1.0);
    EXPECT_EQ(count_equal_cells(map, map, {}), static_cast<std::int64_t>(map.cells.size()));
  }
}

TEST(ImageSimilarity, IsSymmetricOnOneLattice) {
  std::mt19937 random(5);
  for (int run = 0; run < 50; ++run) {
    const OccupancyGrid m1 = random_map(random, 25, 31);
    const OccupancyGrid m2 = random_map(random, 25, 31);
    const ImageSimilarity one = measure_similarity(m1, m2, {});
    const ImageSimilarity other = measure_similarity(m2, m1, {});
    EXPECT_DOUBLE_EQ(one.psi(), other.psi());
    EXPECT_EQ(one.agreement, other.agreement);
    EXPECT_EQ(one.disagreement, other.disagreement);
    EXPECT_EQ(count_equal_cells(m1, m2, {}), count_equal_cells(m2, m1, {}));
  }
}

TEST(ImageSimilarity, AMissingClassIsReportedAndCountsNothing) {
  const OccupancyGrid free = make_grid(6, 4, 0.1, {}, Cell::free);
  OccupancyGrid both = free;
  both.at(3, 2) = Cell::occupied;
  const ImageSimilarity similarity = measure_similarity(free, both, {});
  EXPECT_EQ(similarity.undefined_terms(), 2);
  EXPECT_FALSE(similarity.moving_to_fixed_occupied.defined());
  EXPECT_EQ(similarity.psi(), 1.0 / 24.0);  // one free cell lies on the wall
  const OccupancyGrid nothing = make_grid(6, 4, 0.1);
  EXPECT_EQ(measure_similarity(nothing, both, {}).undefined_terms(), 4);
  EXPECT_EQ(measure_similarity(nothing, nothing, {}).psi(), 0.0);
  EXPECT_EQ(measure_similarity(nothing, nothing, {}).acceptance_index(), 0.0);
}

TEST(ImageSimilarity, AMeterGivesTheSameWhateverItMeasuredBefore) {
  std::mt19937 random(6);
  const OccupancyGrid fixed = random_map(random, 40, 30);
  const OccupancyGrid moving = random_map(random, 20, 45);
  SimilarityMeter meter(fixed, moving);
  meter({100.0, -50.0, 1.0});
  SimilarityMeter copy(meter);
  for (const SE2& T : {SE2{0.3, 0.2, 0.4}, SE2{-3.0, 2.0, 3.0}, SE2{30.0, 0.0, -1.0}, SE2{}}) {
    const ImageSimilarity fresh = measure_similarity(fixed, moving, T);
    for (const ImageSimilarity& again : {meter(T), copy(T)}) {
      EXPECT_EQ(again.psi(), fresh.psi());
      EXPECT_EQ(again.agreement, fresh.agreement);
      EXPECT_EQ(again.disagreement, fresh.disagreement);
    }
  }
}

TEST(ImageSimilarity, CountsDistancesUpToTheLimitInEveryDirection) {
  constexpr int kFar = 29000;  // cells
  for (const auto& [dx, dy] : {std::pair{1, 0}, std::pair{-1, 0}, std::pair{0, 1}, std::pair{0, -1}}) {
    OccupancyGrid fixed = dx != 0 ? make_grid(2000, 1, 1.0) : make_grid(1, 2000, 1.0);
    fixed.cells.front() = fixed.cells.back() = Cell::free;
    const OccupancyGrid moving = make_grid(1, 1, 1.0, {}, Cell::free);
    const ImageSimilarity found =
        measure_similarity(fixed, moving, SE2{1.0 * dx * kFar, 1.0 * dy * kFar, 0.0});
    // The fixed map's two cells are at 0 and 1999 along its length.
    const bool ahead = dx + dy > 0;
    EXPECT_EQ(found.fixed_to_moving_free.sum, kFar + (ahead ? kFar - 1999 : kFar + 1999));
    EXPECT_EQ(found.moving_to_fixed_free.sum, ahead ? kFar - 1999 : kFar);
    EXPECT_EQ(found.fixed_to_moving_free.count, 2);
    SimilarityMeter meter(fixed, moving);
    EXPECT_TRUE(meter.can_measure(SE2{1.0 * dx * kFar, 1.0 * dy * kFar, 0.0}));
    EXPECT_FALSE(meter.can_measure(SE2{1.2 * dx * kFar, 1.2 * dy * kFar, 0.0}));
    EXPECT_FALSE(meter.can_measure(SE2{std::nan(""), 0.0, 0.0}));
  }
}

TEST(Omega, MapsThatLieFarApartHaveNothingEqualButTheUnknown) {
  const OccupancyGrid fixed = make_grid(10, 10, 1.0, {}, Cell::free);
  const OccupancyGrid fine = make_grid(10, 10, 0.02, {}, Cell::free);
  EXPECT_EQ(count_equal_cells(fixed, fine, {-5e5, 0.0, 0.0}), 0);
  EXPECT_EQ(count_equal_cells(make_grid(10, 10, 1.0), fine, {5e5, 7.0, 1.0}), 100);
  EXPECT_THROW(count_equal_cells(fixed, make_grid(1000001, 1, 0.02), {}), std::invalid_argument);
}

TEST(ImageSimilarity, RefusesWhatItCannotMeasure) {
  const OccupancyGrid map = make_grid(6, 4, 0.1, {}, Cell::free);
  EXPECT_THROW(measure_similarity(map, map, {std::nan(""), 0.0, 0.0}), std::invalid_argument);
  EXPECT_THROW(measure_similarity(map, map, {1e4, 0.0, 0.0}), std::invalid_argument);
  EXPECT_THROW(measure_similarity(map, map, {1e300, 0.0, 0.0}), std::invalid_argument);
  const OccupancyGrid fine = make_grid(6, 4, 0.0009, {}, Cell::free);
  EXPECT_THROW(measure_similarity(map, fine, {}), std::invalid_argument);
  EXPECT_THROW(measure_similarity(fine, map, {}), std::invalid_argument);
  EXPECT_THROW(count_equal_cells(fine, map, {}), std::invalid_argument);
  const OccupancyGrid long_map = make_grid(kMaxDistanceMapSides, 1, 0.1, {}, Cell::free);
  EXPECT_THROW(measure_similarity(map, long_map, {}), std::invalid_argument);
  EXPECT_THROW(count_equal_cells(map, map, {0.0, 0.0, std::nan("")}), std::invalid_argument);
  // A map that is none, whichever of the two it is.
  OccupancyGrid broken = map;
  broken.cells.pop_back();
  EXPECT_THROW(measure_similarity(map, broken, {}), std::invalid_argument);
  EXPECT_THROW(measure_similarity(broken, map, {}), std::invalid_argument);
  EXPECT_THROW(SimilarityMeter(map, broken), std::invalid_argument);
  EXPECT_THROW(SimilarityMeter(broken, map), std::invalid_argument);
}

TEST(Omega, CountsEqualValues) {
  OccupancyGrid m1 = make_grid(3, 1, 1.0);
  m1.cells = {Cell::unknown, Cell::free, Cell::occupied};
  OccupancyGrid m2 = m1;
  EXPECT_EQ(count_equal_cells(m1, m2, {}), 3);
  m2.cells = {Cell::free, Cell::free, Cell::unknown};
  EXPECT_EQ(count_equal_cells(m1, m2, {}), 1);
  EXPECT_EQ(count_equal_cells(m1, m2, {1.0, 0.0, 0.0}), 2);  // what is beyond the moving map is unknown
}

}  // namespace
}  // namespace gridmerge
