// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace gridmerge::test {

/// `value` as `bytes` bytes, the lowest first.
std::string little_endian(std::uint64_t value, int bytes);

/// A Windows bitmap, byte by byte, so that tests can write what no program would.
struct BmpBuilder {
  std::int32_t width = 1;
  std::int32_t height = 1;  ///< negative: the top row comes first
  std::uint32_t bits = 24;
  std::uint32_t compression = 0;
  std::uint32_t colors = 0;
  std::string palette;  ///< or masks
  std::string rows;     ///< filled up to whole words
  std::uint32_t header_size = 40;
  int raster_shift = 0;  ///< of where the header says that the rows begin

  std::string build() const;
};

/// 24 bits per pixel, the top row of `values` first.
std::string gray_bmp(int width, int height, const std::vector<std::uint8_t>& values);

/// Made by libjpeg at quality 75, the top row of `values` first; of several channels they follow each other.
std::string gray_jpeg(int width, int height, const std::vector<std::uint8_t>& values);
std::string rgb_jpeg(int width, int height, const std::vector<std::uint8_t>& values,
                     bool progressive = false);

}  // namespace gridmerge::test
