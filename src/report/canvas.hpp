// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include "gridmerge/report/merge_output.hpp"
#include "io/png.hpp"
#include "report/font.hpp"

namespace gridmerge::internal {

/// An RGB picture to draw on, in pixels from its upper left corner. What lies outside is cut off.
class Canvas {
 public:
  Canvas(int width, int height, Colour fill);

  int width() const { return image_.width; }
  int height() const { return image_.height; }
  const PngImage& image() const { return image_; }

  void fill(int x, int y, int width, int height, Colour colour);
  void draw(int x, int y, const Canvas& other);

  /// Writes a text in UTF-8, the upper left corner of its line at (x, y).
  void write(int x, int y, TextSize size, std::string_view text, Colour colour);

 private:
  /// `share` of the colour over what is there.
  void blend(int x, int y, Colour colour, double share);

  PngImage image_;
};

}  // namespace gridmerge::internal
