// SPDX-License-Identifier: Apache-2.0
#include "canvas.hpp"

#include <algorithm>
#include <cstddef>

#include "font.hpp"

namespace gridmerge {

namespace {
constexpr int kAdvance = kGlyphWidth + 1;
constexpr std::size_t kChannels = 3;
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
    for (int column = left; column < right; ++column) {
      const std::size_t pixel = static_cast<std::size_t>(row) * static_cast<std::size_t>(image_.width) +
                                static_cast<std::size_t>(column);
      image_.samples[pixel * kChannels] = colour.red;
      image_.samples[pixel * kChannels + 1] = colour.green;
      image_.samples[pixel * kChannels + 2] = colour.blue;
    }
  }
}

void Canvas::draw(int x, int y, const Canvas& other) {
  for (int row = 0; row < other.height(); ++row) {
    for (int column = 0; column < other.width(); ++column) {
      const std::size_t pixel = (static_cast<std::size_t>(row) * static_cast<std::size_t>(other.width()) +
                                 static_cast<std::size_t>(column)) *
                                kChannels;
      const auto& samples = other.image_.samples;
      fill(x + column, y + row, 1, 1, {samples[pixel], samples[pixel + 1], samples[pixel + 2]});
    }
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
