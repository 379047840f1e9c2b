// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace gridmerge {

/// An integer image, row-major.
template <typename Value>
struct Image {
  int width = 0;
  int height = 0;
  std::vector<Value> values;
};
using EvidenceImage = Image<std::int8_t>;
using ScoreImage = Image<std::int16_t>;

/// Outputs are computed in blocks of this many columns.
inline constexpr int kCorrelateBlock = 64;

/// Inputs must lie in [-kMaxCorrelated, kMaxCorrelated], so that eight of them fit a sum of 8 bits.
inline constexpr int kMaxCorrelated = 15;

/// output(x, y) = sum over `offsets` of input.values[first + y * input.width + x + offset], for every value
/// of `output`, whose width must be a multiple of kCorrelateBlock. Every index must lie inside the input, and
/// sums must fit 16 bits. O(output values * offsets); vectorised.
void correlate(const EvidenceImage& input, std::size_t first, const std::vector<std::int32_t>& offsets,
               ScoreImage& output);

}  // namespace gridmerge
