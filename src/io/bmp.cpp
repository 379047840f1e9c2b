// SPDX-License-Identifier: Apache-2.0
// A reader of our own: what map editors write is a header and rows of bytes. Debian's one small library for
// it (libnsbmp) is in few other systems' packages.
#include "io/bmp.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <vector>

#include "io/parse_error.hpp"

namespace gridmerge::internal {

namespace {

// Places in the file: its own header, then the picture's.
constexpr std::size_t kRasterAt = 10, kHeaderSizeAt = 14, kWidthAt = 18, kHeightAt = 22, kBitsAt = 28,
                      kCompressionAt = 30, kColorsAt = 46, kMasksAt = 54;
constexpr std::uint32_t kFileHeader = 14, kInfoHeader = 40, kV3Header = 56;
constexpr std::uint32_t kPlain = 0, kWithMasks = 3;
constexpr std::uint16_t kWhite = 3 * 255;  // lightness is the sum of the three colours

class Bytes {
 public:
  explicit Bytes(std::string_view bytes) : bytes_(bytes) {}

  std::uint8_t byte(std::size_t at) const {
    if (at >= bytes_.size()) throw ParseError("the file ends within its header");
    return static_cast<std::uint8_t>(bytes_[at]);
  }
  std::uint32_t word16(std::size_t at) const {
    return byte(at) | static_cast<std::uint32_t>(byte(at + 1)) << 8;
  }
  std::uint32_t word32(std::size_t at) const { return word16(at) | word16(at + 2) << 16; }
  std::size_t size() const { return bytes_.size(); }

 private:
  std::string_view bytes_;  // little-endian
};

struct Header {
  std::uint64_t width = 0;
  std::uint64_t height = 0;
  bool is_top_first = false;
  std::uint32_t bits = 0;
  bool has_alpha = false;
  std::size_t palette = 0;  // where it begins
  std::uint32_t colors = 0;
  std::size_t raster = 0;
};

void check_masks(const Bytes& bytes) {
  constexpr std::uint32_t kUsual[] = {0x00ff0000, 0x0000ff00, 0x000000ff};
  for (std::size_t i = 0; i < 3; ++i) {
    if (bytes.word32(kMasksAt + 4 * i) != kUsual[i])
      throw ParseError("a BMP whose colours lie in an unusual order: save it as PNG");
  }
}

Header read_header(const Bytes& bytes) {
  const std::uint32_t header_size = bytes.word32(kHeaderSizeAt);
  if (header_size < kInfoHeader) throw ParseError("a BMP of OS/2: save it as PNG");
  Header header;
  const auto width = static_cast<std::int32_t>(bytes.word32(kWidthAt));
  const auto height = static_cast<std::int32_t>(bytes.word32(kHeightAt));
  if (width < 0) throw ParseError("its width is negative");
  header.width = static_cast<std::uint64_t>(width);
  header.height = static_cast<std::uint64_t>(std::abs(static_cast<std::int64_t>(height)));
  header.is_top_first = height < 0;
  header.bits = bytes.word16(kBitsAt);
  const std::uint32_t compression = bytes.word32(kCompressionAt);
  const bool has_masks = compression == kWithMasks && header.bits == 32;
  if (compression != kPlain && !has_masks) throw ParseError("a compressed BMP: save it as PNG");
  if (has_masks) check_masks(bytes);
  header.has_alpha = has_masks && header_size >= kV3Header && bytes.word32(kMasksAt + 12) == 0xff000000;
  switch (header.bits) {
    case 1:
    case 4:
    case 8: {
      const std::uint32_t most = 1U << header.bits;
      const std::uint32_t colors = bytes.word32(kColorsAt);
      header.colors = colors == 0 ? most : std::min(colors, most);
      break;
    }
    case 24:
    case 32:
      break;
    default:
      throw ParseError(fmt::format("a BMP of {} bits per pixel: save it as PNG", header.bits));
  }
  header.palette = std::size_t{kFileHeader} + header_size;
  header.raster = bytes.word32(kRasterAt);
  return header;
}

std::vector<std::uint16_t> read_palette(const Bytes& bytes, const Header& header) {
  std::vector<std::uint16_t> lightness;
  for (std::size_t i = 0; i < header.colors; ++i) {
    const std::size_t at = header.palette + 4 * i;
    lightness.push_back(static_cast<std::uint16_t>(bytes.byte(at) + bytes.byte(at + 1) + bytes.byte(at + 2)));
  }
  return lightness;
}

}  // namespace

bool looks_like_bmp(std::string_view bytes) {
  // Two letters alone could begin a YAML: four bytes that are 0 follow them, and a header's size below 256.
  return bytes.size() > kHeaderSizeAt + 3 && bytes.starts_with("BM") &&
         bytes.substr(6, 4) == std::string_view("\0\0\0\0", 4) &&
         bytes.substr(kHeaderSizeAt + 1, 3) == std::string_view("\0\0\0", 3);
}

ImageSize bmp_size(std::string_view head) {
  const Header header = read_header(Bytes(head));
  return {header.width, header.height};
}

MapImage decode_bmp(std::string_view text, std::size_t max_pixels) {
  if (!looks_like_bmp(text)) throw ParseError("not a BMP image");
  const Bytes bytes(text);
  const Header header = read_header(bytes);
  check_image_size(header.width, header.height, max_pixels);
  const std::vector<std::uint16_t> palette = read_palette(bytes, header);
  // Rows are filled up to whole words. With sizes of 31 bits and an offset of 32, no sum exceeds 64 bits.
  const std::uint64_t row_bytes = (header.width * header.bits + 31) / 32 * 4;
  if (header.raster + row_bytes * header.height > bytes.size()) throw ParseError("the image data end early");

  MapImage image;
  image.width = static_cast<int>(header.width);
  image.height = static_cast<int>(header.height);
  image.white = kWhite;
  image.lightness.resize(header.width * header.height);
  if (header.has_alpha) image.alpha.resize(image.lightness.size());
  std::size_t pixel = 0;
  for (std::uint64_t row = 0; row < header.height; ++row) {
    const std::uint64_t line = header.is_top_first ? row : header.height - 1 - row;
    const std::size_t start = header.raster + line * row_bytes;
    for (std::uint64_t column = 0; column < header.width; ++column, ++pixel) {
      if (header.bits <= 8) {
        const std::uint64_t bit = column * header.bits;
        const std::uint32_t shift = 8 - header.bits - static_cast<std::uint32_t>(bit % 8);
        const std::uint32_t index = bytes.byte(start + bit / 8) >> shift & ((1U << header.bits) - 1);
        if (index >= palette.size())
          throw ParseError(fmt::format("a pixel's colour {} is not in the palette", index));
        image.lightness[pixel] = palette[index];
      } else {
        const std::size_t at = start + column * header.bits / 8;
        image.lightness[pixel] =
            static_cast<std::uint16_t>(bytes.byte(at) + bytes.byte(at + 1) + bytes.byte(at + 2));
        if (header.has_alpha) image.alpha[pixel] = bytes.byte(at + 3);
      }
    }
  }
  // Writers that know of no alpha leave 0 in its place.
  if (std::all_of(image.alpha.begin(), image.alpha.end(), [](std::uint8_t alpha) { return alpha == 0; }))
    image.alpha.clear();
  return image;
}

}  // namespace gridmerge::internal
