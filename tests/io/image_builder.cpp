// SPDX-License-Identifier: Apache-2.0
#include "image_builder.hpp"

#include <algorithm>
#include <cstdio>
#include <cstdlib>

// After <cstdio>, which it needs.
#include <jpeglib.h>

namespace gridmerge::test {

std::string little_endian(std::uint64_t value, int bytes) {
  std::string text;
  for (int i = 0; i < bytes; ++i) text += static_cast<char>(value >> 8 * i & 0xff);
  return text;
}

std::string BmpBuilder::build() const {
  std::string picture = little_endian(header_size, 4) + little_endian(static_cast<std::uint32_t>(width), 4) +
                        little_endian(static_cast<std::uint32_t>(height), 4) + little_endian(1, 2) +
                        little_endian(bits, 2) + little_endian(compression, 4) + little_endian(0, 4) +
                        little_endian(2835, 4) + little_endian(2835, 4) + little_endian(colors, 4) +
                        little_endian(0, 4) + palette;
  const std::size_t raster = 14 + picture.size();
  return "BM" + little_endian(raster + rows.size(), 4) + little_endian(0, 4) +
         little_endian(raster + static_cast<std::size_t>(raster_shift), 4) + picture + rows;
}

std::string gray_bmp(int width, int height, const std::vector<std::uint8_t>& values) {
  BmpBuilder bmp{.width = width, .height = height, .palette = {}, .rows = {}};
  for (int row = height - 1; row >= 0; --row) {
    for (int column = 0; column < width; ++column)
      bmp.rows += std::string(3, static_cast<char>(values[static_cast<std::size_t>(row * width + column)]));
    while (bmp.rows.size() % 4 != 0) bmp.rows += '\0';
  }
  return bmp.build();
}

namespace {

std::string jpeg_of(int width, int height, int channels, const std::vector<std::uint8_t>& values,
                    bool progressive) {
  jpeg_compress_struct jpeg{};
  jpeg_error_mgr errors{};
  jpeg.err = jpeg_std_error(&errors);
  jpeg_create_compress(&jpeg);
  unsigned char* buffer = nullptr;
  unsigned long size = 0;
  jpeg_mem_dest(&jpeg, &buffer, &size);
  jpeg.image_width = static_cast<JDIMENSION>(width);
  jpeg.image_height = static_cast<JDIMENSION>(height);
  jpeg.input_components = channels;
  jpeg.in_color_space = channels == 1 ? JCS_GRAYSCALE : channels == 3 ? JCS_RGB : JCS_CMYK;
  jpeg_set_defaults(&jpeg);
  if (progressive) jpeg_simple_progression(&jpeg);
  jpeg_start_compress(&jpeg, TRUE);
  std::vector<std::uint8_t> copy = values;
  while (jpeg.next_scanline < jpeg.image_height) {
    JSAMPROW row = copy.data() +
                   static_cast<std::size_t>(jpeg.next_scanline) * static_cast<std::size_t>(width * channels);
    jpeg_write_scanlines(&jpeg, &row, 1);
  }
  jpeg_finish_compress(&jpeg);
  jpeg_destroy_compress(&jpeg);
  const std::string bytes(reinterpret_cast<const char*>(buffer), size);
  std::free(buffer);
  return bytes;
}

}  // namespace

std::string gray_jpeg(int width, int height, const std::vector<std::uint8_t>& values) {
  return jpeg_of(width, height, 1, values, false);
}

std::string rgb_jpeg(int width, int height, const std::vector<std::uint8_t>& values, bool progressive) {
  return jpeg_of(width, height, 3, values, progressive);
}

}  // namespace gridmerge::test
