// SPDX-License-Identifier: Apache-2.0
#include "canvas.hpp"

#include <algorithm>
#include <cstddef>

#include "font.hpp"

namespace gridmerge {

namespace {
constexpr int kAdvance = kGlyphWidth + 1;
constexpr std::size_t kChannels = 3;

std::size_t sample_at(const PngImage& image, int x, int y) {
  return (static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) + static_cast<std::size_t>(x)) *
         kChannels;
}

}  // namespace

Canvas::Canvas(int width, int height, Colour colour) {
  image_.width = width;
  image_.height = height;
  image_.samples.resize(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * kChannels);
  fill(0, 0, width, height, colour);
}

void Canvas::fill(int x, int y, int width, int height, Colour colour) {
  const int left = std::max(x, 0), right = std::min(x + width, image_.width);
  const int top = std::max(y, 0), bottom = std::min(y + height, image_.height);
  for (int row = top; row < bottom; ++row) {
    std::size_t sample = sample_at(image_, left, row);
    for (int column = left; column < right; ++column) {
      image_.samples[sample++] = colour.red;
      image_.samples[sample++] = colour.green;
      image_.samples[sample++] = colour.blue;
    }
  }
}

void Canvas::draw(int x, int y, const Canvas& other) {
  const int left = std::max(x, 0), right = std::min(x + other.width(), image_.width);
  const int top = std::max(y, 0), bottom = std::min(y + other.height(), image_.height);
  if (left >= right) return;
  for (int row = top; row < bottom; ++row) {
    const auto from = other.image_.samples.begin() +
                      static_cast<std::ptrdiff_t>(sample_at(other.image_, left - x, row - y));
    const auto to = image_.samples.begin() + static_cast<std::ptrdiff_t>(sample_at(image_, left, row));
    std::copy_n(from, static_cast<std::size_t>(right - left) * kChannels, to);
  }
}

void Canvas::write(int x, int y, int scale, std::string_view ascii, Colour colour) {
  for (const char c : ascii) {
    const Glyph& glyph = kFont[static_cast<std::size_t>(c - kFirstGlyph)];
    for (int row = 0; row < kGlyphHeight; ++row) {
      for (int dot = 0; dot < kGlyphWidth; ++dot) {
        const bool set = (glyph.rows[static_cast<std::size_t>(row)] >> (kGlyphWidth - 1 - dot) & 1) != 0;
        if (set) fill(x + dot * scale, y + row * scale, scale, scale, colour);
      }
    }
    x += kAdvance * scale;
  }
}

int text_width(std::string_view ascii, int scale) {
  return ascii.empty() ? 0 : (static_cast<int>(ascii.size()) * kAdvance - 1) * scale;
}

int text_height(int scale) {
  return kGlyphHeight * scale;
}

std::string to_ascii(std::string_view utf8) {
  std::string ascii;
  for (const char c : utf8) {
    const bool continues = (static_cast<unsigned char>(c) & 0xC0) == 0x80;
    if (!continues) ascii += c >= kFirstGlyph && c <= kLastGlyph ? c : '?';
  }
  return ascii;
}

std::string fit_width(const std::string& ascii, int scale, int width) {
  if (text_width(ascii, scale) <= width) return ascii;
  const int fitting = std::max(2, (width / scale + 1) / kAdvance);
  return ".." + ascii.substr(ascii.size() - static_cast<std::size_t>(fitting - 2));
}

}  // namespace gridmerge
