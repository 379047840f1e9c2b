// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "internal_export.hpp"

namespace gridmerge::internal {

/// Pixels as a PNG holds them, top row first, no gamma applied.
struct PngImage {
  int width = 0;
  int height = 0;
  int channels = 3;                   ///< 1 gray, 2 gray and alpha, 3 RGB, 4 RGB and alpha
  int bit_depth = 8;                  ///< of a channel: 8, or 16 (big-endian)
  std::vector<std::uint8_t> samples;  ///< width * height * channels * bit_depth / 8 bytes
};

/// Reads any PNG: palettes become RGB, 1, 2 and 4 bits become 8, transparent colours an alpha channel.
/// Throws std::runtime_error with the cause when the bytes are no PNG, are broken or end early, or when the
/// image has more than `max_pixels` pixels (found out before memory is taken for them). O(pixels).
GRIDMERGE_INTERNAL_EXPORT PngImage decode_png(std::string_view bytes, std::size_t max_pixels = 1u << 28);

/// The bytes of a PNG file. Throws std::invalid_argument unless bit_depth is 8 and samples fits the sizes.
/// O(pixels).
GRIDMERGE_INTERNAL_EXPORT std::string encode_png(const PngImage& image);

}  // namespace gridmerge::internal
