// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string_view>

namespace gridmerge::internal {

/// What the pixels of a PNG become: palettes RGB, 1, 2 and 4 bits 8, transparent colours an alpha channel.
struct PngFormat {
  int width = 0;
  int height = 0;
  int channels = 0;   ///< 1 gray, 2 gray and alpha, 3 RGB, 4 RGB and alpha
  int bit_depth = 0;  ///< of a channel: 8, or 16 (big-endian)

  std::size_t pixel_bytes() const { return static_cast<std::size_t>(channels * bit_depth / 8); }
};

/// Pixels of one row: every one, or, of an interlaced picture, those of one pass.
struct PngRow {
  int y = 0;
  int first = 0;  ///< x of the first one
  int step = 1;   ///< to the next one's x
  int count = 0;
  const std::uint8_t* samples = nullptr;  ///< count * pixel_bytes()
};

/// Reads a PNG row by row: calls `begin` once, then `row` until every pixel was there once. Memory is that of
/// two rows. Throws ParseError as decode_png() does, and what the two throw.
void read_png(std::string_view bytes, std::size_t max_pixels,
              const std::function<void(const PngFormat&)>& begin,
              const std::function<void(const PngRow&)>& row);

}  // namespace gridmerge::internal
