// SPDX-License-Identifier: Apache-2.0
#include "report/font.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

#include "io/png.hpp"
#include "report/font_characters.hpp"
#include "report/font_picture.hpp"

namespace gridmerge::internal {

namespace {

// As make_font.py draws them, in the picture's pixels.
constexpr int kColumns = 32, kCellWidth = 84, kCellHeight = 76;
constexpr int kLeft = 8;       // from a cell's edge to where its letter begins
constexpr int kBaseline = 59;  // below the row that holds the advances
constexpr char32_t kReplacement = 0xfffd;
constexpr std::string_view kEllipsis = "\u2026";

const PngImage& picture() {
  static const PngImage image = decode_png(kFontPicture);
  return image;
}

std::uint8_t gray_at(int x, int y) {
  const PngImage& image = picture();
  return image.samples[static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) +
                       static_cast<std::size_t>(x)];
}

/// The place of a character in the picture.
int index_of(char32_t character) {
  int index = 0;
  for (const auto& [first, last] : kFontCharacters) {
    if (character >= first && character <= last) return index + static_cast<int>(character - first);
    index += static_cast<int>(last - first) + 1;
  }
  return index_of(kReplacement);
}

struct Glyph {
  int x = 0;  // upper left corner of its cell
  int y = 0;
  int advance = 0;
};

Glyph glyph_of(char32_t character) {
  const int index = index_of(character);
  Glyph glyph{index % kColumns * kCellWidth, index / kColumns * kCellHeight, 0};
  while (glyph.advance < kCellWidth && gray_at(glyph.x + glyph.advance, glyph.y) != 0) ++glyph.advance;
  return glyph;
}

bool continues(char byte) {
  return (static_cast<unsigned char>(byte) & 0xC0) == 0x80;
}

/// Takes the first character off a text that is not empty.
char32_t take_character(std::string_view& text) {
  const auto lead = static_cast<unsigned char>(text.front());
  text.remove_prefix(1);
  if (lead < 0x80) return lead;
  const int more = lead >= 0xF0 ? 3 : lead >= 0xE0 ? 2 : lead >= 0xC0 ? 1 : 0;
  char32_t character = lead & (0x3F >> more);
  int taken = 0;
  while (taken < more && !text.empty() && continues(text.front())) {
    character = character << 6 | (static_cast<unsigned char>(text.front()) & 0x3F);
    text.remove_prefix(1);
    ++taken;
  }
  constexpr std::array<char32_t, 4> kMin{0x80, 0x80, 0x800, 0x10000};  // shorter ones are written shorter
  return more > 0 && taken == more && character >= kMin[static_cast<std::size_t>(more)] ? character
                                                                                        : kReplacement;
}

std::vector<Glyph> glyphs_of(std::string_view text) {
  std::vector<Glyph> glyphs;
  glyphs.reserve(text.size());
  while (!text.empty()) glyphs.push_back(glyph_of(take_character(text)));
  return glyphs;
}

/// In the picture's pixels.
int advance_of(const std::vector<Glyph>& glyphs) {
  int sum = 0;
  for (const Glyph& glyph : glyphs) sum += glyph.advance;
  return sum;
}

int reduced(int pixels, TextSize size) {
  const int factor = static_cast<int>(size);
  return (pixels + factor - 1) / factor;
}

}  // namespace

int line_height(TextSize size) {
  return reduced(kCellHeight - 1, size);
}

int baseline(TextSize size) {
  return reduced(kBaseline, size);
}

int text_width(std::string_view text, TextSize size) {
  return reduced(advance_of(glyphs_of(text)), size);
}

std::string fit_width(std::string_view text, TextSize size, int width) {
  const int room = width * static_cast<int>(size);
  const int whole = advance_of(glyphs_of(text));
  if (whole <= room) return std::string(text);
  int excess = whole + advance_of(glyphs_of(kEllipsis)) - room;
  while (excess > 0 && !text.empty()) excess -= glyph_of(take_character(text)).advance;
  return std::string(kEllipsis) + std::string(text);
}

TextCoverage draw_text(std::string_view text, TextSize size) {
  const int factor = static_cast<int>(size);
  const std::vector<Glyph> glyphs = glyphs_of(text);
  TextCoverage drawn;
  drawn.left = -reduced(kLeft, size);
  drawn.width = reduced(advance_of(glyphs) + kCellWidth, size) - drawn.left;
  drawn.height = line_height(size);
  // Sums of the picture's pixels over each pixel of the text: what a renderer of that size would find
  // covered.
  std::vector<int> sums(static_cast<std::size_t>(drawn.width) * static_cast<std::size_t>(drawn.height), 0);
  int pen = -drawn.left * factor - kLeft;
  for (const Glyph& glyph : glyphs) {
    for (int row = 1; row < kCellHeight; ++row) {
      for (int column = 0; column < kCellWidth; ++column) {
        const int at = (row - 1) / factor * drawn.width + (pen + column) / factor;
        sums[static_cast<std::size_t>(at)] += gray_at(glyph.x + column, glyph.y + row);
      }
    }
    pen += glyph.advance;
  }
  drawn.values.reserve(sums.size());
  for (const int sum : sums) drawn.values += static_cast<char>(std::min(255, sum / (factor * factor)));
  return drawn;
}

}  // namespace gridmerge::internal
