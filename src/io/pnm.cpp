// SPDX-License-Identifier: Apache-2.0
// A reader of our own: the formats are a few lines, while Debian's readers of them are either netpbm's
// library, which ends the process on bad input, or image suites many times the size of this project.
#include "io/pnm.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>

#include "io/parse_error.hpp"

namespace gridmerge::internal {

namespace {

bool is_space(char c) {
  return c == ' ' || (c >= '\t' && c <= '\r');
}  // as in the "C" locale, always
bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

class Scanner {
 public:
  explicit Scanner(std::string_view bytes) : rest_(bytes) {}

  /// The next decimal number; `what` names it in errors. Comments may stand before it.
  std::uint32_t number(const char* what) {
    skip_space_and_comments();
    if (rest_.empty()) throw ParseError(fmt::format("the file ends before its {}", what));
    std::uint64_t value = 0;
    std::size_t length = 0;
    for (; length < rest_.size() && is_digit(rest_[length]); ++length) {
      value = value * 10 + static_cast<std::uint64_t>(rest_[length] - '0');
      if (value > UINT32_MAX) throw ParseError(fmt::format("its {} is too large a number", what));
    }
    const bool delimited = length == rest_.size() || is_space(rest_[length]) || rest_[length] == '#';
    if (length == 0 || !delimited) throw ParseError(fmt::format("its {} is not a whole number", what));
    rest_.remove_prefix(length);
    return static_cast<std::uint32_t>(value);
  }

  /// What follows the header's last number: one white-space character, then `size` bytes of pixels.
  std::string_view raster(std::size_t size) {
    if (rest_.starts_with('#')) skip_comment();
    // A header edited on Windows ends in two characters; if the data still suffices, the second is not a
    // pixel.
    if (rest_.starts_with("\r\n") && rest_.size() - 2 >= size) rest_.remove_prefix(1);
    if (!rest_.empty()) rest_.remove_prefix(1);
    if (rest_.size() < size) {
      throw ParseError(fmt::format("the image data end early: {} bytes of {}", rest_.size(), size));
    }
    return rest_.substr(0, size);
  }

  std::size_t remaining() const { return rest_.size(); }

 private:
  void skip_comment() { rest_.remove_prefix(std::min(rest_.find_first_of("\r\n"), rest_.size())); }

  void skip_space_and_comments() {
    while (!rest_.empty()) {
      if (rest_.front() == '#') {
        skip_comment();
      } else if (is_space(rest_.front())) {
        rest_.remove_prefix(1);
      } else {
        return;
      }
    }
  }

  std::string_view rest_;
};

// A pixel's lightness is the sum of its colours, or, where that does not fit, their mean.
class Pixels {
 public:
  Pixels(MapImage& image, std::uint16_t maximum, std::size_t channels)
      : image_(image), maximum_(maximum), channels_(channels), is_mean_(maximum * channels > UINT16_MAX) {
    image.white = static_cast<std::uint16_t>(is_mean_ ? maximum : maximum * channels);
  }

  void add(std::uint32_t value) {
    if (value > maximum_)
      throw ParseError(fmt::format("a pixel's value {} exceeds the header's maximum {}", value, maximum_));
    sum_ += value;
    if (++channel_ < channels_) return;
    image_.lightness.push_back(
        static_cast<std::uint16_t>(is_mean_ ? (sum_ + channels_ / 2) / channels_ : sum_));
    sum_ = channel_ = 0;
  }

 private:
  MapImage& image_;
  std::uint32_t maximum_;
  std::size_t channels_;
  bool is_mean_;
  std::size_t channel_ = 0;
  std::size_t sum_ = 0;
};

void read_plain(Scanner& scanner, Pixels& pixels, std::size_t values) {
  for (std::size_t i = 0; i < values; ++i) pixels.add(scanner.number("image data"));
}

void read_raw(std::string_view raster, Pixels& pixels, bool is_wide) {
  const auto byte = [&](std::size_t index) { return static_cast<std::uint8_t>(raster[index]); };
  for (std::size_t i = 0; i < raster.size(); i += is_wide ? 2 : 1)
    pixels.add(is_wide ? static_cast<std::uint32_t>(byte(i) << 8 | byte(i + 1)) : byte(i));
}

}  // namespace

bool is_plain_pnm(std::string_view bytes) {
  return looks_like_pnm(bytes) && (bytes[1] == '2' || bytes[1] == '3');
}

bool looks_like_pnm(std::string_view bytes) {
  if (bytes.size() < 3 || bytes[0] != 'P') return false;
  const char kind = bytes[1];
  return (kind == '2' || kind == '3' || kind == '5' || kind == '6') &&
         (is_space(bytes[2]) || bytes[2] == '#');
}

ImageSize pnm_size(std::string_view head) {
  Scanner scanner(head.substr(2));
  const std::uint32_t width = scanner.number("width");
  return {width, scanner.number("height")};
}

MapImage decode_pnm(std::string_view bytes, std::size_t max_pixels) {
  if (!looks_like_pnm(bytes)) throw ParseError("not a PGM (P2 or P5) or PPM (P3 or P6) image");
  Scanner scanner(bytes.substr(2));
  const std::uint32_t width = scanner.number("width");
  const std::uint32_t height = scanner.number("height");
  const std::uint32_t maximum = scanner.number("maximum value");
  check_image_size(width, height, max_pixels);
  if (maximum < 1 || maximum > 65535) {
    throw ParseError(fmt::format("its maximum value {} is not in 1..65535", maximum));
  }

  const bool is_plain = is_plain_pnm(bytes);
  const std::size_t channels = bytes[1] == '3' || bytes[1] == '6' ? 3 : 1;
  const std::size_t size = static_cast<std::size_t>(width) * height;
  const bool is_wide = maximum > 255;
  MapImage image;
  image.width = static_cast<int>(width);
  image.height = static_cast<int>(height);
  Pixels pixels(image, static_cast<std::uint16_t>(maximum), channels);
  // Before any memory is taken for pixels: a small file cannot stand for a large image. A plain value takes a
  // digit and a space at least.
  if (is_plain && scanner.remaining() / 2 + 1 < channels * size) throw ParseError("the image data end early");
  const std::string_view raster =
      is_plain ? std::string_view() : scanner.raster(channels * size * (is_wide ? 2 : 1));
  image.lightness.reserve(size);
  is_plain ? read_plain(scanner, pixels, channels * size) : read_raw(raster, pixels, is_wide);
  return image;
}

std::string encode_pgm(int width, int height, std::span<const std::uint8_t> values) {
  std::string bytes = fmt::format("P5\n{} {}\n255\n", width, height);
  bytes.append(values.begin(), values.end());
  return bytes;
}

}  // namespace gridmerge::internal
