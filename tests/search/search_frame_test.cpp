// SPDX-License-Identifier: Apache-2.0
#include "search/search_frame.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <random>
#include <utility>
#include <vector>

#include "search/rotations.hpp"

namespace gridmerge::internal {
namespace {

bool same(const Peak& a, const Peak& b) {
  return a.rotation == b.rotation && a.x == b.x && a.y == b.y && a.score == b.score;
}

/// The best first, without those that have a better one within two steps in all of x, y and rotation.
std::vector<Peak> distinct_by_definition(std::vector<Peak> peaks, int rotations, std::size_t most) {
  std::sort(peaks.begin(), peaks.end());
  std::vector<Peak> kept;
  for (const Peak& peak : peaks) {
    const bool has_better = std::any_of(kept.begin(), kept.end(), [&](const Peak& other) {
      const int turn = std::abs(other.rotation - peak.rotation);
      return std::min(turn, rotations - turn) <= 2 && std::abs(other.x - peak.x) <= 2 &&
             std::abs(other.y - peak.y) <= 2;
    });
    if (!has_better && kept.size() < most) kept.push_back(peak);
  }
  return kept;
}

TEST(KeepDistinct, EqualsTheDefinition) {
  std::mt19937 random(3);
  for (int run = 0; run < 60; ++run) {
    const int rotations = 8 + run % 5;
    std::vector<Peak> peaks(static_cast<std::size_t>(40 + 10 * run));
    for (Peak& peak : peaks)
      peak = {static_cast<int>(random() % static_cast<unsigned>(rotations)),
              static_cast<int>(random() % 25) - 12, static_cast<int>(random() % 25) - 12,
              static_cast<int>(random() % 30)};
    const std::size_t most = run % 3 == 0 ? 5 : 1000;
    const std::vector<Peak> expected = distinct_by_definition(peaks, rotations, most),
                            found = keep_distinct(peaks, rotations, most);
    ASSERT_TRUE(std::equal(found.begin(), found.end(), expected.begin(), expected.end(), same)) << run;
  }
}

TEST(BestPeaks, AreAboveAQuarterOfTheBest) {
  ScoreImage scores;
  resize(scores, 20, 9);
  std::fill(scores.values.begin(), scores.values.end(), std::int16_t{0});
  const auto set = [&](int x, int y, std::int16_t score) {
    scores.values[static_cast<std::size_t>(y) * scores.width + static_cast<std::size_t>(x)] = score;
  };
  set(3, 3, 40);
  set(8, 3, 10);
  set(13, 3, 11);
  TurnedWalls turned;
  turned.first_x = 100;
  turned.first_y = -7;
  turned.shifts_x = 20;
  std::vector<Peak> peaks = best_peaks(scores, turned, 5);
  std::sort(peaks.begin(), peaks.end());
  ASSERT_EQ(peaks.size(), 2u);
  EXPECT_TRUE(same(peaks[0], {5, 103, -4, 40}));
  EXPECT_TRUE(same(peaks[1], {5, 113, -4, 11}));
}

TEST(BestPeaks, AreAboveTheFloorThatIsAskedForToo) {
  ScoreImage scores;
  resize(scores, ScoreBlock::kColumns, 8);
  std::fill(scores.values.begin(), scores.values.end(), std::int16_t{0});
  for (const int x : {3, 8, 13})
    scores.values[static_cast<std::size_t>(3 * scores.width + x)] = static_cast<std::int16_t>(4 * x);
  TurnedWalls turned;
  turned.shifts_x = ScoreBlock::kColumns;
  std::vector<ScoreBlock> all;
  for (int y = 0; y < scores.height; y += ScoreBlock::kRows) all.push_back({0, y});
  // A quarter of the best is 13.
  const std::vector<std::pair<int, std::size_t>> found{{0, 2}, {13, 2}, {31, 2}, {32, 1}, {51, 1}, {52, 0}};
  for (const auto& [floor, count] : found)
    EXPECT_EQ(best_peaks(scores, all, turned, 0, floor).size(), count) << floor;
}

TEST(BestPeaks, OfARotationAreNinetySix) {
  ScoreImage scores;
  resize(scores, 401, 9);
  std::fill(scores.values.begin(), scores.values.end(), std::int16_t{0});
  for (int i = 0; i < 120; ++i)
    scores.values[static_cast<std::size_t>(4) * scores.width + 2 + 3 * static_cast<std::size_t>(i)] =
        static_cast<std::int16_t>(500 + (7 * i) % 120);
  TurnedWalls turned;
  turned.shifts_x = 401;
  const std::vector<Peak> peaks = best_peaks(scores, turned, 0);
  ASSERT_EQ(peaks.size(), 96u);
  for (const Peak& peak : peaks) EXPECT_GE(peak.score, 500 + 24);
}

TEST(ForeseenScore, IsThatOfThePeakBehindAsManyAsThePilotsHaveOfThem) {
  std::vector<Peak> pilots;
  for (int i = 0; i < 100; ++i) pilots.push_back({0, 10 * i, 0, 1000 - i});
  // Three times 80 candidates of all rotations are 30 of every eighth.
  EXPECT_EQ(foreseen_score(pilots, 80, 3), 970);
  std::mt19937 random(4);
  std::shuffle(pilots.begin(), pilots.end(), random);
  EXPECT_EQ(foreseen_score(pilots, 80, 3), 970);
  EXPECT_EQ(foreseen_score(pilots, 264, 3), 901);
  EXPECT_EQ(foreseen_score(pilots, 267, 3), 0);  // as many as there are: nothing is foreseen
  EXPECT_EQ(foreseen_score(pilots, 2, 3), 0);
}

LikelihoodField field_of(int width, int height) {
  LikelihoodField field;
  field.width = width;
  field.height = height;
  return field;
}

/// Walls all over a map of 60 x 40 cells.
std::vector<WallPoint> some_walls() {
  std::mt19937 random(5);
  std::vector<WallPoint> walls(80);
  for (WallPoint& wall : walls)
    wall.position = {static_cast<double>(random() % 6000) / 100.0,
                     static_cast<double>(random() % 4000) / 100.0};
  return walls;
}

TEST(SearchFrame, PosesPutWallsIntoTheCellsOfTheirSamples) {
  const std::vector<WallPoint> walls = some_walls();
  const SearchFrame frame = make_search_frame(field_of(101, 50), field_of(60, 40), 3, 16);
  EXPECT_EQ(frame.fixed_width, 34);
  EXPECT_EQ(frame.fixed_height, 17);
  EXPECT_EQ(frame.box, 27);  // the diagonal of 72.1 cells, and one more on either side
  for (int rotation = 0; rotation < 16; ++rotation) {
    const TurnedWalls turned = turn_walls(walls, frame, rotation, 8);
    for (const int right : {0, 3, turned.shifts_x - 1}) {
      const Peak peak{rotation, turned.first_x + right, turned.first_y + 2, 0};
      const SE2 T = frame.pose(peak);
      int differing = 0;
      for (std::size_t i = 0; i < walls.size(); ++i) {
        const Point2 p = T * walls[i].position;
        const int x = static_cast<int>(std::floor(p.x / 3.0)), y = static_cast<int>(std::floor(p.y / 3.0));
        const bool is_there = x == turned.samples[i].x + right && y == turned.samples[i].y + 2;
        differing += is_there ? 0 : 1;
      }
      EXPECT_LE(differing, 2) << rotation;  // on the very edge of a cell
    }
  }
}

TEST(TurnWalls, HasAllShiftsAtWhichEnoughWallsCanMeet) {
  const std::vector<WallPoint> walls = some_walls();
  const SearchFrame frame = make_search_frame(field_of(101, 50), field_of(60, 40), 3, 16);
  for (const std::size_t least : {1u, 8u, 40u, 79u}) {
    for (const int rotation : {0, 3, 7}) {
      const TurnedWalls turned = turn_walls(walls, frame, rotation, least);
      // Of each shift along x: how many samples lie in the fixed map's columns then.
      const auto inside = [&](int shift) {
        return static_cast<std::size_t>(
            std::count_if(turned.samples.begin(), turned.samples.end(), [&](const Sample& sample) {
              return sample.x + shift >= 0 && sample.x + shift < frame.fixed_width;
            }));
      };
      const auto inside_rows = [&](int shift) {
        return static_cast<std::size_t>(
            std::count_if(turned.samples.begin(), turned.samples.end(), [&](const Sample& sample) {
              return sample.y + shift >= 0 && sample.y + shift < frame.fixed_height;
            }));
      };
      for (int shift = -200; shift < 200; ++shift) {
        if (shift < 1 || shift >= turned.shifts_x - 1) {
          EXPECT_LT(inside(shift), least) << shift;
        }
        if (shift < 1 || shift >= turned.shifts_y - 1) {
          EXPECT_LT(inside_rows(shift), least) << shift;
        }
      }
      // And no more of them than that, and a rim.
      if (turned.shifts_x > 2) {
        EXPECT_GE(inside(1), least);
        EXPECT_GE(inside(turned.shifts_x - 2), least);
      }
    }
  }
}

}  // namespace
}  // namespace gridmerge::internal
