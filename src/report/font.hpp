// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "gridmerge/report/merge_output.hpp"

namespace gridmerge::internal {

/// How large a text is: the pixels of the font's picture in one pixel of the text.
enum class TextSize : int {
  large = 2,  ///< titles and legends
  small = 3,  ///< captions
  tiny = 5,   ///< numbers in cells
};

/// Pixels from the top of a line to the next one's.
int line_height(TextSize size);

/// Pixels from the top of a line to what its letters stand on.
int baseline(TextSize size);

/// Width of a text in UTF-8 [pixels]. O(length).
int text_width(std::string_view text, TextSize size);

/// The text, or "…" and as much of its end as fits `width` pixels: the end of a path tells most. O(length).
std::string fit_width(std::string_view text, TextSize size, int width);

/// How much of a pixel a text covers, 0 to 255: a rectangle, top row first.
struct TextCoverage {
  int left = 0;  ///< of the rectangle, beside where the text begins [pixels]; letters may reach out
  int width = 0;
  int height = 0;
  std::string values;  ///< bytes, width * height
};

/// A text in UTF-8, drawn. A character that the font does not have, and what is no UTF-8, is U+FFFD.
/// O(pixels).
TextCoverage draw_text(std::string_view text, TextSize size);

}  // namespace gridmerge::internal
