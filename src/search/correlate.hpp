// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace gridmerge {

/// An integer image with row 0 at the bottom; `width` is a multiple of kCorrelateBlock where it is an output.
struct ScoreImage {
  int width = 0;
  int height = 0;
  std::vector<std::int16_t> values;
};

/// Outputs are computed in blocks of this many columns.
inline constexpr int kCorrelateBlock = 64;

/// output(x, y) = sum over `offsets` of input.values[y * input.width + x + offset]. Every index must lie
/// inside the input, also for the columns that pad the output to whole blocks, and sums must fit 16 bits.
/// O(output cells * offsets); vectorised.
void correlate(const ScoreImage& input, const std::vector<std::int32_t>& offsets, ScoreImage& output);

}  // namespace gridmerge
