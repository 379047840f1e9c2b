// SPDX-License-Identifier: Apache-2.0
#include "search/local_maxima.hpp"

#include <gtest/gtest.h>

#include <random>

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

TEST(LocalMaxima, MaximumPassesOverTheColumnsThatOnlyFillUpABlock) {
  const ScoreImage scores{4, 2, {1, 2, 3, 9, -1, 5, 0, 9}};
  EXPECT_EQ(find_maximum(scores, 3), 5);
  EXPECT_EQ(find_maximum({2, 1, {-4, -9}}, 2), 0);
}

}  // namespace
}  // namespace gridmerge
