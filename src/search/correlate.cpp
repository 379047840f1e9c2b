// SPDX-License-Identifier: Apache-2.0
#include "correlate.hpp"

#include <cstring>

namespace gridmerge {

namespace {

// 16 lanes of 16 bits: one AVX2 register, or two of SSE2.
using Lanes = std::int16_t __attribute__((vector_size(32)));
// The same for unaligned loads.
using UnalignedLanes = std::int16_t __attribute__((vector_size(32), aligned(2), may_alias));
constexpr int kLanes = 16;
static_assert(kCorrelateBlock == 4 * kLanes);

#if defined(__x86_64__) && defined(__linux__) && !defined(__SANITIZE_THREAD__) && \
    !defined(__SANITIZE_ADDRESS__)
// One build for every x86-64 machine: the loader picks the variant. Sanitizers run before the resolver can.
#define GRIDMERGE_MULTIVERSION __attribute__((target_clones("avx2", "default")))
#else
#define GRIDMERGE_MULTIVERSION
#endif

/// The accumulators of one block stay in registers while all offsets are added.
GRIDMERGE_MULTIVERSION
void correlate_row(const std::int16_t* input, const std::int32_t* offsets, std::size_t count,
                   std::int16_t* output, int width) {
  for (int x = 0; x < width; x += kCorrelateBlock) {
    Lanes sum0{}, sum1{}, sum2{}, sum3{};
    for (std::size_t i = 0; i < count; ++i) {
      const auto* lanes = reinterpret_cast<const UnalignedLanes*>(input + x + offsets[i]);
      sum0 += lanes[0];
      sum1 += lanes[1];
      sum2 += lanes[2];
      sum3 += lanes[3];
    }
    auto* out = reinterpret_cast<UnalignedLanes*>(output + x);
    out[0] = sum0;
    out[1] = sum1;
    out[2] = sum2;
    out[3] = sum3;
  }
}

}  // namespace

void correlate(const ScoreImage& input, std::size_t first, const std::vector<std::int32_t>& offsets,
               ScoreImage& output) {
  for (int y = 0; y < output.height; ++y) {
    correlate_row(input.values.data() + first + static_cast<std::size_t>(y) * input.width, offsets.data(),
                  offsets.size(), output.values.data() + static_cast<std::size_t>(y) * output.width,
                  output.width);
  }
}

}  // namespace gridmerge
