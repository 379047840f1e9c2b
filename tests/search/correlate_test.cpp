// SPDX-License-Identifier: Apache-2.0
#include "correlate.hpp"

#include <gtest/gtest.h>

#include <random>
#include <utility>
#include <vector>

#include "gridmerge/search/exhaustive.hpp"

namespace gridmerge {
namespace {

TEST(Correlate, EqualsTheLiteralSum) {
  std::mt19937 random(11);
  const auto below = [&](int limit) { return static_cast<int>(random() % static_cast<unsigned>(limit)); };
  for (int run = 0; run < 20; ++run) {
    ScoreImage output;
    output.width = kCorrelateBlock * (1 + below(3));
    output.height = 1 + below(20);
    EvidenceImage input;
    input.width = output.width + below(50);
    input.height = output.height + 1 + below(30);
    for (int i = 0; i < input.width * input.height; ++i)
      input.values.push_back(static_cast<std::int8_t>(below(2 * kMaxCorrelated + 1) - kMaxCorrelated));
    output.values.assign(static_cast<std::size_t>(output.width) * output.height, 77);

    const int first = below(3);
    const int room = input.width * (input.height - output.height) + (input.width - output.width) - first;
    std::vector<std::int32_t> offsets;
    for (int i = below(40); i > 0; --i) offsets.push_back(below(room + 1));

    correlate(input, first, offsets, output);
    for (int y = 0; y < output.height; ++y) {
      for (int x = 0; x < output.width; ++x) {
        int sum = 0;
        for (const int offset : offsets) sum += input.values[first + y * input.width + x + offset];
        ASSERT_EQ(output.values[y * output.width + x], sum) << run << " " << x << " " << y;
      }
    }
  }
}

// Vectors of 32 bytes are read from anywhere, and written to rows that a std::vector aligns to 16 bytes at
// best.
TEST(Correlate, ReadsAndWritesAtEveryAlignment) {
  std::mt19937 random(12);
  EvidenceImage input{kCorrelateBlock + 96, 3, {}};
  for (int i = 0; i < input.width * input.height; ++i)
    input.values.push_back(static_cast<std::int8_t>(static_cast<int>(random() % 31) - kMaxCorrelated));
  std::vector<std::vector<std::int16_t>> kept;  // so that the next one lies elsewhere
  for (std::size_t first = 0; first < 32; ++first) {
    for (std::int32_t offset = 0; offset < 32; ++offset) {
      const std::size_t spare = 8 * (kept.size() % 3);
      ScoreImage output{kCorrelateBlock, 2, std::vector<std::int16_t>(2 * kCorrelateBlock + spare, 77)};
      correlate(input, first, {offset, offset + 1, 31}, output);
      for (int y = 0; y < output.height; ++y) {
        for (int x = 0; x < output.width; ++x) {
          const std::int8_t* at = input.values.data() + first + y * input.width + x;
          ASSERT_EQ(output.values[y * output.width + x], at[offset] + at[offset + 1] + at[31])
              << first << " " << offset << " " << x << " " << y;
        }
      }
      for (std::size_t i = 0; i < spare; ++i) ASSERT_EQ(output.values[2 * kCorrelateBlock + i], 77);
      kept.push_back(std::move(output.values));
    }
  }
}

TEST(Correlate, DoesNotOverflowWithTheLargestInputs) {
  for (const int value : {kMaxCorrelated, -kMaxCorrelated}) {
    EvidenceImage input{kCorrelateBlock, 1,
                        std::vector<std::int8_t>(kCorrelateBlock, static_cast<std::int8_t>(value))};
    ScoreImage output{kCorrelateBlock, 1, std::vector<std::int16_t>(kCorrelateBlock, 0)};
    correlate(input, 0, std::vector<std::int32_t>(kMaxSearchSamples, 0), output);
    for (const std::int16_t sum : output.values) ASSERT_EQ(sum, value * static_cast<int>(kMaxSearchSamples));
  }
}

}  // namespace
}  // namespace gridmerge
