// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace gridmerge::test {

/// PNG's colour types.
enum class PngColor : std::uint8_t { gray = 0, rgb = 2, palette = 3, gray_alpha = 4, rgba = 6 };

/// A PNG assembled by hand, so that the decoder meets kinds that our encoder does not write, and broken ones.
struct PngBuilder {
  std::uint32_t width = 1;
  std::uint32_t height = 1;
  std::uint8_t bit_depth = 8;
  PngColor color = PngColor::gray;
  std::string rows = {};          ///< packed pixels, rows of whole bytes, without filter bytes
  std::string palette = {};       ///< PLTE data; empty: no such chunk
  std::string transparency = {};  ///< tRNS data; empty: no such chunk

  std::string build() const;
};

/// A chunk: length, type, data, checksum.
std::string png_chunk(std::string_view type, std::string_view data);

/// "\xff\x80" and the like with their length, NULs included.
inline std::string bytes(std::initializer_list<int> values) {
  std::string text;
  for (const int value : values) text += static_cast<char>(value);
  return text;
}

}  // namespace gridmerge::test
