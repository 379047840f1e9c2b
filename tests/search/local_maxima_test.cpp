// SPDX-License-Identifier: Apache-2.0
#include "search/local_maxima.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <tuple>
#include <vector>

namespace gridmerge {

using namespace internal;
namespace {

/// Few values, so that there are plateaus.
ScoreImage random_scores(std::mt19937& random, int width, int height) {
  ScoreImage scores{width, height, {}};
  for (int i = 0; i < width * height; ++i)
    scores.values.push_back(static_cast<std::int16_t>(random() % 7) - 2);
  return scores;
}

TEST(LocalMaxima, EqualTheDefinition) {
  std::mt19937 random(5);
  for (int run = 0; run < 50; ++run) {
    const ScoreImage scores = random_scores(random, 3 + static_cast<int>(random() % 90), 3 + run % 9);
    const int columns = scores.width - static_cast<int>(random() % 3);
    const int floor = run % 3;
    const auto at = [&](int x, int y) { return static_cast<int>(scores.values[y * scores.width + x]); };
    std::vector<LocalMaximum> expected;
    for (int y = 1; y + 1 < scores.height; ++y) {
      for (int x = 1; x + 1 < columns; ++x) {
        bool is_maximum = at(x, y) > floor;
        for (int dy = -1; dy <= 1; ++dy) {
          for (int dx = -1; dx <= 1; ++dx) {
            const bool later = dy > 0 || (dy == 0 && dx > 0);
            const int other = at(x + dx, y + dy);
            if (later ? other >= at(x, y) : other > at(x, y)) is_maximum = false;
          }
        }
        if (is_maximum) expected.push_back({x, y, at(x, y)});
      }
    }
    const std::vector<LocalMaximum> found = find_local_maxima(scores, columns, floor);
    ASSERT_EQ(found.size(), expected.size()) << run;
    for (std::size_t i = 0; i < found.size(); ++i) {
      EXPECT_EQ(found[i].x, expected[i].x);
      EXPECT_EQ(found[i].y, expected[i].y);
      EXPECT_EQ(found[i].score, expected[i].score);
    }
  }
}

TEST(LocalMaxima, OfBlocksAreThoseOfTheWholeImageThatLieInThem) {
  std::mt19937 random(6);
  for (int run = 0; run < 50; ++run) {
    ScoreImage scores = random_scores(random, 2 * kCorrelateBlock, 2 + run % 9);
    const int columns = 3 + static_cast<int>(random() % (2 * kCorrelateBlock - 2));
    const int floor = run % 3;
    std::vector<ScoreBlock> blocks;
    for (int y = 0; y < scores.height; y += ScoreBlock::kRows) {
      for (int x = 0; x < columns; x += ScoreBlock::kColumns)
        if (random() % 2 == 0) blocks.push_back({x, y});
    }
    const auto in_a_block = [&](int x, int y) {
      return std::any_of(blocks.begin(), blocks.end(), [&](const ScoreBlock& block) {
        return x >= block.x && x < block.x + ScoreBlock::kColumns && y >= block.y &&
               y < block.y + ScoreBlock::kRows;
      });
    };
    for (int y = 0; y < scores.height; ++y) {
      for (int x = 0; x < scores.width; ++x)
        if (!in_a_block(x, y)) scores.values[y * scores.width + x] = kNotLookedAt;
    }
    const auto in_reading_order = [](const LocalMaximum& a, const LocalMaximum& b) {
      return std::tie(a.y, a.x, a.score) < std::tie(b.y, b.x, b.score);
    };
    const std::vector<LocalMaximum> expected = find_local_maxima(scores, columns, floor);
    std::vector<LocalMaximum> found = find_local_maxima(scores, blocks, columns, floor);
    std::sort(found.begin(), found.end(), in_reading_order);
    EXPECT_TRUE(std::equal(
        found.begin(), found.end(), expected.begin(), expected.end(),
        [&](const auto& a, const auto& b) { return !in_reading_order(a, b) && !in_reading_order(b, a); }))
        << "run " << run;
    EXPECT_EQ(find_maximum(scores, blocks, columns), find_maximum(scores, columns)) << "run " << run;
  }
}

TEST(LocalMaxima, AnImageOfThreeColumnsHasOneThatCanHoldThem) {
  const ScoreImage scores{4, 4, {0, 1, 0, 8, 1, 5, 1, 8, 0, 4, 0, 8, 0, 0, 0, 8}};
  ASSERT_EQ(find_local_maxima(scores, 3, 0).size(), 1U);
  EXPECT_EQ(find_local_maxima(scores, 3, 0)[0].score, 5);
  EXPECT_TRUE(find_local_maxima(scores, 2, 0).empty());
}

TEST(LocalMaxima, MaximumPassesOverTheColumnsThatOnlyFillUpABlock) {
  const ScoreImage scores{4, 2, {1, 2, 3, 9, -1, 5, 0, 9}};
  EXPECT_EQ(find_maximum(scores, 3), 5);
  EXPECT_EQ(find_maximum({2, 1, {-4, -9}}, 2), 0);
}

}  // namespace
}  // namespace gridmerge
