// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <tuple>
#include <utility>
#include <vector>

#include "gridmerge/report/merge_output.hpp"
#include "io/png.hpp"

namespace gridmerge::test {

using Rgb = std::tuple<int, int, int>;

inline Rgb rgb(Colour colour) {
  return {colour.red, colour.green, colour.blue};
}

struct Picture {
  internal::PngImage image;

  Rgb at(int x, int y) const {
    const auto i =
        (static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) + static_cast<std::size_t>(x)) *
        3;
    return {image.samples[i], image.samples[i + 1], image.samples[i + 2]};
  }

  // The pixels of a colour, rows first.
  std::vector<std::pair<int, int>> pixels(Colour colour) const {
    std::vector<std::pair<int, int>> found;
    for (int y = 0; y < image.height; ++y) {
      for (int x = 0; x < image.width; ++x) {
        if (at(x, y) == rgb(colour)) found.emplace_back(x, y);
      }
    }
    return found;
  }

  // How many map cells have the colour, drawn `zoom` pixels wide. The legend's samples are smaller than a
  // cell here.
  std::size_t cells(Colour colour, std::size_t zoom = 32) const {
    return pixels(colour).size() / (zoom * zoom);
  }
};

}  // namespace gridmerge::test
