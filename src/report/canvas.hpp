// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "gridmerge/io/png.hpp"
#include "gridmerge/report/preview.hpp"

namespace gridmerge {

/// An RGB picture to draw on, in pixels from its upper left corner. What lies outside is cut off.
class Canvas {
 public:
  Canvas(int width, int height, Colour fill);

  int width() const { return image_.width; }
  int height() const { return image_.height; }
  const PngImage& image() const { return image_; }

  void fill(int x, int y, int width, int height, Colour colour);
  void draw(int x, int y, const Canvas& other);

  /// Writes in the built-in font, every dot of it `scale` pixels wide, the upper left corner at (x, y).
  void write(int x, int y, int scale, std::string_view ascii, Colour colour);

 private:
  PngImage image_;
};

/// Size of a text in pixels; the height includes what hangs below the line.
int text_width(std::string_view ascii, int scale);
int text_height(int scale);

/// What the built-in font can show of a text: any character beyond printable ASCII becomes '?'.
std::string to_ascii(std::string_view utf8);

/// The text, or ".." and as much of its end as fits `width` pixels: the end of a path tells most.
std::string fit_width(const std::string& ascii, int scale, int width);

}  // namespace gridmerge
