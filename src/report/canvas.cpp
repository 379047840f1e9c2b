// SPDX-License-Identifier: Apache-2.0
#include "report/canvas.hpp"

#include <algorithm>
#include <cstddef>

#include "report/style.hpp"

namespace gridmerge::internal {

namespace {
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

void Canvas::write(int x, int y, TextSize size, std::string_view text, Colour colour) {
  const TextCoverage coverage = draw_text(text, size);
  for (int row = 0; row < coverage.height; ++row) {
    for (int column = 0; column < coverage.width; ++column) {
      const std::size_t at = static_cast<std::size_t>(row) * static_cast<std::size_t>(coverage.width) +
                             static_cast<std::size_t>(column);
      const auto covered = static_cast<unsigned char>(coverage.values[at]);
      if (covered != 0) blend(x + coverage.left + column, y + row, colour, covered / 255.0);
    }
  }
}

void Canvas::blend(int x, int y, Colour colour, double share) {
  if (x < 0 || y < 0 || x >= image_.width || y >= image_.height) return;
  const std::size_t sample = sample_at(image_, x, y);
  const Colour below{image_.samples[sample], image_.samples[sample + 1], image_.samples[sample + 2]};
  const Colour blended = mix(below, colour, share);
  fill(x, y, 1, 1, blended);
}

}  // namespace gridmerge::internal
