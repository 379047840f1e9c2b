// SPDX-License-Identifier: Apache-2.0
#include "correlate.hpp"

#include "../grid/multiversion.hpp"
#include "../grid/unaligned.hpp"

namespace gridmerge {

namespace {

// 32 lanes of 8 bits and 16 lanes of 16: one AVX2 register each, or two of SSE2.
using Bytes = std::int8_t __attribute__((vector_size(32)));
using Words = std::int16_t __attribute__((vector_size(32)));
constexpr int kLanes = 32;
constexpr std::size_t kGroup = 8;  // inputs that fit a sum of 8 bits
static_assert(kCorrelateBlock == 2 * kLanes);
static_assert(kMaxCorrelated * kGroup <= 127);

using HalfBytes = std::int8_t __attribute__((vector_size(16)));

inline void add_widened(const Bytes& sum, Words& low, Words& high) {
  const HalfBytes first =
      __builtin_shufflevector(sum, sum, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
  const HalfBytes second =
      __builtin_shufflevector(sum, sum, 16, 17, 18, 19, 20, 21, 22, 23, 24, 25, 26, 27, 28, 29, 30, 31);
  low += __builtin_convertvector(first, Words);
  high += __builtin_convertvector(second, Words);
}

/// The sums of one block stay in registers while all offsets are added: in 8 bits for a group of them, which
/// halves the memory to read, then in 16.
GRIDMERGE_MULTIVERSION
void correlate_row(const std::int8_t* input, const std::int32_t* offsets, std::size_t count,
                   std::int16_t* output, int width) {
  for (int x = 0; x < width; x += kCorrelateBlock) {
    Words sum0{}, sum1{}, sum2{}, sum3{};
    for (std::size_t first = 0; first < count; first += kGroup) {
      const std::size_t last = first + kGroup < count ? first + kGroup : count;
      Bytes group0{}, group1{};
      for (std::size_t i = first; i < last; ++i) {
        const std::int8_t* const at = input + x + offsets[i];
        Bytes lanes0, lanes1;
        load(at, lanes0);
        load(at + kLanes, lanes1);
        group0 += lanes0;
        group1 += lanes1;
      }
      add_widened(group0, sum0, sum1);
      add_widened(group1, sum2, sum3);
    }
    store(sum0, output + x);
    store(sum1, output + x + kLanes / 2);
    store(sum2, output + x + kLanes);
    store(sum3, output + x + kLanes + kLanes / 2);
  }
}

}  // namespace

void correlate(const EvidenceImage& input, std::size_t first, const std::vector<std::int32_t>& offsets,
               ScoreImage& output) {
  for (int y = 0; y < output.height; ++y) {
    correlate_row(input.values.data() + first + static_cast<std::size_t>(y) * input.width, offsets.data(),
                  offsets.size(), output.values.data() + static_cast<std::size_t>(y) * output.width,
                  output.width);
  }
}

}  // namespace gridmerge
