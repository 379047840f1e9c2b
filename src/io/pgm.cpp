// SPDX-License-Identifier: Apache-2.0
// A reader of our own: the format is a few lines, while Debian's readers of it are either netpbm's library,
// which ends the process on bad input, or image suites many times the size of this project.
#include "pgm.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "parse_error.hpp"

namespace gridmerge {

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

[[noreturn]] void throw_above_maximum(std::uint32_t value, std::uint16_t maximum) {
  throw ParseError(fmt::format("a pixel's value {} exceeds the header's maximum {}", value, maximum));
}

void read_plain(Scanner& scanner, MapImage& image, std::size_t size) {
  // A value takes a digit and a space at least: a small file cannot make us take memory for a large image.
  if (scanner.remaining() / 2 + 1 < size) throw ParseError("the image data end early");
  image.lightness.reserve(size);
  while (image.lightness.size() < size) {
    const std::uint32_t value = scanner.number("image data");
    if (value > image.white) throw_above_maximum(value, image.white);
    image.lightness.push_back(static_cast<std::uint16_t>(value));
  }
}

void read_raw(Scanner& scanner, MapImage& image, std::size_t size) {
  const bool wide = image.white > 255;
  const std::string_view raster = scanner.raster(wide ? 2 * size : size);
  const auto byte = [&](std::size_t index) { return static_cast<std::uint8_t>(raster[index]); };
  image.lightness.resize(size);
  for (std::size_t i = 0; i < size; ++i) {
    image.lightness[i] = wide ? static_cast<std::uint16_t>(byte(2 * i) << 8 | byte(2 * i + 1)) : byte(i);
  }
  const auto largest = *std::max_element(image.lightness.begin(), image.lightness.end());
  if (largest > image.white) throw_above_maximum(largest, image.white);
}

}  // namespace

bool looks_like_pgm(std::string_view bytes) {
  return (bytes.starts_with("P2") || bytes.starts_with("P5")) && bytes.size() > 2 &&
         (is_space(bytes[2]) || bytes[2] == '#');
}

MapImage decode_pgm(std::string_view bytes, std::size_t max_pixels) {
  if (!looks_like_pgm(bytes)) throw ParseError("not a PGM image (P2 or P5)");
  Scanner scanner(bytes.substr(2));
  const std::uint32_t width = scanner.number("width");
  const std::uint32_t height = scanner.number("height");
  const std::uint32_t maximum = scanner.number("maximum value");
  check_image_size(width, height, max_pixels);
  if (maximum < 1 || maximum > 65535) {
    throw ParseError(fmt::format("its maximum value {} is not in 1..65535", maximum));
  }

  MapImage image;
  image.width = static_cast<int>(width);
  image.height = static_cast<int>(height);
  image.white = static_cast<std::uint16_t>(maximum);
  const std::size_t size = static_cast<std::size_t>(width) * height;
  bytes[1] == '2' ? read_plain(scanner, image, size) : read_raw(scanner, image, size);
  return image;
}

std::string encode_pgm(int width, int height, std::span<const std::uint8_t> values) {
  std::string bytes = fmt::format("P5\n{} {}\n255\n", width, height);
  bytes.append(values.begin(), values.end());
  return bytes;
}

}  // namespace gridmerge
