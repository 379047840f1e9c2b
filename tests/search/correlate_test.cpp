// SPDX-License-Identifier: Apache-2.0
#include "search/correlate.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <utility>
#include <vector>

#include "search/exhaustive.hpp"

namespace gridmerge {

using namespace internal;
namespace {

int below(std::mt19937& random, int limit) {
  return static_cast<int>(random() % static_cast<unsigned>(limit));
}

EvidenceImage random_image(std::mt19937& random, int width, int height, int planes = 1) {
  EvidenceImage image(width, height, planes);
  for (int plane = 0; plane < planes; ++plane) {
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x)
        image.at(x, y, plane) =
            static_cast<std::int8_t>(below(random, 2 * kMaxCorrelated + 1) - kMaxCorrelated);
    }
  }
  return image;
}

/// All over the image, and beyond it on every side.
std::vector<Sample> random_samples(std::mt19937& random, const EvidenceImage& image, int planes = 1) {
  std::vector<Sample> samples;
  for (int i = below(random, 40); i > 0; --i) {
    samples.push_back({below(random, 3 * image.width() + 200) - 2 * image.width() - 100,
                       below(random, 3 * image.height() + 20) - 2 * image.height() - 10,
                       below(random, planes)});
  }
  return samples;
}

ScoreImage blank(int width, int height) {
  return {width, height, std::vector<std::int16_t>(static_cast<std::size_t>(width) * height, 77)};
}

int literal_sum(const EvidenceImage& image, const std::vector<Sample>& samples, int x, int y) {
  int sum = 0;
  for (const Sample& sample : samples) {
    const int column = sample.x + x, row = sample.y + y;
    if (column < 0 || row < 0 || column >= image.width() || row >= image.height()) continue;
    sum += image.at(column, row, sample.plane);
  }
  return sum;
}

TEST(Correlate, EqualsTheLiteralSum) {
  std::mt19937 random(11);
  for (int run = 0; run < 60; ++run) {
    const int planes = 1 + below(random, 3);
    const EvidenceImage image = random_image(random, 1 + below(random, 150), 1 + below(random, 30), planes);
    const std::vector<Sample> samples = random_samples(random, image, planes);
    ScoreImage output = blank(kCorrelateBlock * (1 + below(random, 3)), 1 + below(random, 40));
    correlate(image, samples, output);
    for (int y = 0; y < output.height; ++y) {
      for (int x = 0; x < output.width; ++x)
        ASSERT_EQ(output.values[y * output.width + x], literal_sum(image, samples, x, y)) << run;
    }
  }
}

TEST(Correlate, DoesNotOverflowWithTheLargestInputs) {
  for (const int value : {kMaxCorrelated, -kMaxCorrelated}) {
    EvidenceImage image(kCorrelateBlock, 1);
    for (int x = 0; x < image.width(); ++x) image.at(x, 0) = static_cast<std::int8_t>(value);
    ScoreImage output = blank(kCorrelateBlock, 1);
    correlate(image, std::vector<Sample>(kMaxSearchSamples, {0, 0}), output);
    for (const std::int16_t sum : output.values) ASSERT_EQ(sum, value * static_cast<int>(kMaxSearchSamples));
  }
}

TEST(Correlate, NoScoreExceedsTheBoundOfItsFourShifts) {
  std::mt19937 random(13);
  for (int run = 0; run < 60; ++run) {
    const EvidenceImage image = random_image(random, 1 + below(random, 150), 1 + below(random, 30));
    const std::vector<Sample> samples = random_samples(random, image);
    const EvidenceImage pooled = pool_pairs(image);
    ScoreImage bounds = blank(kCorrelateBlock, 20);
    correlate(pooled, pool_pairs(samples), bounds);
    for (int y = 0; y < bounds.height; ++y) {
      for (int x = 0; x < bounds.width; ++x) {
        int tight = 0;  // the sum of the largest values, sample by sample
        for (const Sample& sample : samples) {
          int largest = -kMaxCorrelated;
          for (int i = 0; i < 4; ++i)
            largest = std::max(largest, literal_sum(image, {sample}, 2 * x + i % 2, 2 * y + i / 2));
          tight += largest;
        }
        ASSERT_EQ(bounds.values[y * bounds.width + x], tight) << run << " " << x << " " << y;
      }
    }
  }
}

TEST(PoolScores, HaveTheLargestOfEachTwoByTwo) {
  std::mt19937 random(15);
  for (int run = 0; run < 30; ++run) {
    ScoreImage scores = blank(kCorrelateBlock * (1 + below(random, 3)), 1 + below(random, 20));
    for (std::int16_t& score : scores.values) score = static_cast<std::int16_t>(below(random, 2001) - 1000);
    ScoreImage pooled = blank(kCorrelateBlock, 3);  // of an earlier call
    pool_scores(scores, pooled);
    ASSERT_EQ(pooled.width % kCorrelateBlock, 0);
    ASSERT_GE(pooled.width, scores.width / 2);
    ASSERT_LT(pooled.width, scores.width / 2 + kCorrelateBlock);
    ASSERT_EQ(pooled.height, (scores.height + 1) / 2);
    ASSERT_EQ(pooled.values.size(), static_cast<std::size_t>(pooled.width) * pooled.height);
    for (int y = 0; y < pooled.height; ++y) {
      for (int x = 0; x < scores.width / 2; ++x) {
        int largest = -32768;
        for (int i = 0; i < 4; ++i) {
          const int row = std::min(2 * y + i / 2, scores.height - 1), column = 2 * x + i % 2;
          largest = std::max(largest, int{scores.values[row * scores.width + column]});
        }
        ASSERT_EQ(pooled.values[y * pooled.width + x], largest) << run << " " << x << " " << y;
      }
    }
  }
}

TEST(Correlate, LooksWhereAScoreMayBeLargeEnoughAndIsRightThere) {
  std::mt19937 random(14);
  std::size_t passed_over = 0;
  for (int run = 0; run < 60; ++run) {
    const EvidenceImage image = random_image(random, 1 + below(random, 150), 1 + below(random, 30));
    const std::vector<Sample> samples = random_samples(random, image);
    ScoreImage bounds = blank(kCorrelateBlock * 2, 1 + below(random, 20));
    correlate(pool_pairs(image), pool_pairs(samples), bounds);
    ScoreImage output = blank(kCorrelateBlock * 3, 2 * bounds.height - below(random, 2));
    const int least = 1 + below(random, 90);
    correlate_where(image, samples, bounds, least, output);
    for (int y = 0; y < output.height; ++y) {
      for (int x = 0; x < output.width; ++x) {
        const int score = output.values[y * output.width + x], right = literal_sum(image, samples, x, y);
        if (score == kNotLookedAt) {
          ++passed_over;
          ASSERT_LT(right, least) << run << " " << x << " " << y;
        } else {
          ASSERT_EQ(score, right) << run << " " << x << " " << y;
        }
      }
    }
  }
  EXPECT_GT(passed_over, 1000U);
}

}  // namespace
}  // namespace gridmerge
