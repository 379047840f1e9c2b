// SPDX-License-Identifier: Apache-2.0
#include "io/png_builder.hpp"

#include <zlib.h>

#include <stdexcept>

namespace gridmerge::test {

namespace {

std::string big_endian(std::uint32_t value) {
  return bytes({static_cast<int>(value >> 24), static_cast<int>(value >> 16 & 255),
                static_cast<int>(value >> 8 & 255), static_cast<int>(value & 255)});
}

const Bytef* as_bytef(std::string_view text) {
  return reinterpret_cast<const Bytef*>(text.data());
}

std::string deflate(const std::string& data) {
  uLongf size = compressBound(data.size());
  std::string packed(size, '\0');
  if (compress(reinterpret_cast<Bytef*>(packed.data()), &size, as_bytef(data), data.size()) != Z_OK) {
    throw std::runtime_error("deflate failed");
  }
  packed.resize(size);
  return packed;
}

}  // namespace

std::string png_chunk(std::string_view type, std::string_view data) {
  const std::string body = std::string(type) + std::string(data);
  const uLong checksum = crc32(0, as_bytef(body), static_cast<uInt>(body.size()));
  return big_endian(static_cast<std::uint32_t>(data.size())) + body +
         big_endian(static_cast<std::uint32_t>(checksum));
}

std::string PngBuilder::build() const {
  const std::string header =
      big_endian(width) + big_endian(height) + bytes({bit_depth, static_cast<int>(color), 0, 0, 0});
  std::string png = "\x89PNG\r\n\x1a\n" + png_chunk("IHDR", header);
  if (!palette.empty()) png += png_chunk("PLTE", palette);
  if (!transparency.empty()) png += png_chunk("tRNS", transparency);

  std::string filtered;
  const std::size_t row_size = height > 0 ? rows.size() / height : 0;
  for (std::uint32_t row = 0; row_size > 0 && row < height; ++row) {
    filtered += '\0' + rows.substr(row * row_size, row_size);
  }
  return png + png_chunk("IDAT", deflate(filtered)) + png_chunk("IEND", "");
}

}  // namespace gridmerge::test
