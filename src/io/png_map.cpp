// SPDX-License-Identifier: Apache-2.0
#include "io/png_map.hpp"

#include <cstdint>

#include "io/png_rows.hpp"

namespace gridmerge::internal {

namespace {

// `Depth` is the number of bytes of a channel, `Colors` the number of colour channels before an alpha
// channel.
template <int Depth, int Colors>
void convert_row(const PngRow& row, int channels, MapImage& image) {
  const auto sample = [&](std::size_t index) -> std::uint32_t {
    if constexpr (Depth == 1) return row.samples[index];
    return static_cast<std::uint32_t>(row.samples[2 * index] << 8 | row.samples[2 * index + 1]);
  };
  const bool has_alpha = channels > Colors;
  std::size_t pixel = static_cast<std::size_t>(row.y) * static_cast<std::size_t>(image.width) +
                      static_cast<std::size_t>(row.first);
  for (int i = 0; i < row.count; ++i, pixel += static_cast<std::size_t>(row.step)) {
    const auto first = static_cast<std::size_t>(i) * static_cast<std::size_t>(channels);
    std::uint32_t sum = 0;
    for (std::size_t channel = 0; channel < Colors; ++channel) sum += sample(first + channel);
    if constexpr (Depth == 2 && Colors == 3)
      sum = (sum + 1) / 3;  // three of 16 bits do not fit; round the mean
    image.lightness[pixel] = static_cast<std::uint16_t>(sum);
    if (has_alpha) {
      const std::uint32_t alpha = sample(first + Colors);
      image.alpha[pixel] = static_cast<std::uint8_t>(Depth == 1 ? alpha : alpha * 255 / 65535);
    }
  }
}

}  // namespace

bool looks_like_png(std::string_view bytes) {
  return bytes.starts_with("\x89PNG\r\n\x1a\n");
}

std::optional<ImageSize> png_size(std::string_view head) {
  constexpr std::size_t kWidthAt = 16, kHeightAt = 20;  // of the first chunk, big-endian
  if (head.size() < kHeightAt + 4) return std::nullopt;
  const auto number = [&](std::size_t at) {
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < 4; ++i) value = value << 8 | static_cast<std::uint8_t>(head[at + i]);
    return value;
  };
  return ImageSize{number(kWidthAt), number(kHeightAt)};
}

MapImage decode_png_map(std::string_view bytes, std::size_t max_pixels) {
  MapImage image;
  PngFormat format;
  const auto begin = [&](const PngFormat& told) {
    format = told;
    image.width = format.width;
    image.height = format.height;
    const std::size_t size = static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
    image.lightness.resize(size);
    if (format.channels % 2 == 0) image.alpha.resize(size);
    image.white = format.bit_depth == 16 ? 65535 : format.channels >= 3 ? 3 * 255 : 255;
  };
  read_png(bytes, max_pixels, begin, [&](const PngRow& row) {
    const bool color = format.channels >= 3;
    if (format.bit_depth == 16) {
      color ? convert_row<2, 3>(row, format.channels, image) : convert_row<2, 1>(row, format.channels, image);
    } else {
      color ? convert_row<1, 3>(row, format.channels, image) : convert_row<1, 1>(row, format.channels, image);
    }
  });
  return image;
}

}  // namespace gridmerge::internal
