// SPDX-License-Identifier: Apache-2.0
#include "report/font.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <random>
#include <vector>

#include "io/png.hpp"
#include "report/font_characters.hpp"
#include "report/font_picture.hpp"
#include "report/utf8.hpp"

namespace gridmerge {

using namespace internal;
namespace {

using test::utf8;

constexpr TextSize kSizes[] = {TextSize::large, TextSize::small, TextSize::tiny};

/// How much ink a text takes, in fully covered pixels.
double ink(std::string_view text, TextSize size) {
  const TextCoverage drawn = draw_text(text, size);
  return std::accumulate(drawn.values.begin(), drawn.values.end(), 0.0,
                         [](double sum, char value) { return sum + static_cast<unsigned char>(value); }) /
         255.0;
}

TEST(Font, EveryCharacterThatItListsHasAWidthAndALookOfItsOwn) {
  const std::string unknown = draw_text("\ufffd", TextSize::large).values;
  for (const auto& [first, last] : kFontCharacters) {
    for (char32_t character = first; character <= last; ++character) {
      const std::string text = utf8(character);
      EXPECT_GT(text_width(text, TextSize::tiny), 0) << static_cast<int>(character);
      const bool blank = character == ' ' || character == 0xa0;
      EXPECT_EQ(ink(text, TextSize::large) == 0.0, blank) << static_cast<int>(character);
      if (character != 0xfffd) {
        EXPECT_NE(draw_text(text, TextSize::large).values, unknown);
      }
    }
  }
}

TEST(Font, SizesAreTheSameLettersReduced) {
  for (const std::string_view text : {"robot_1.yaml", "Gänge, Ωμέγα, карта"}) {
    const double whole = ink(text, TextSize::large) * 4;
    for (const TextSize size : kSizes) {
      const int factor = static_cast<int>(size);
      EXPECT_NEAR(ink(text, size) * factor * factor / whole, 1.0, 0.03) << text;
      EXPECT_NEAR(text_width(text, size) * factor, text_width(text, TextSize::large) * 2, factor + 2);
      EXPECT_LT(baseline(size), line_height(size));
    }
  }
}

/// The ink of each column of pixels, from where the text begins.
std::map<int, double> ink_by_column(std::string_view text, TextSize size) {
  const TextCoverage drawn = draw_text(text, size);
  std::map<int, double> columns;
  for (std::size_t i = 0; i < drawn.values.size(); ++i) {
    const int column = drawn.left + static_cast<int>(i) % drawn.width;
    columns[column] += static_cast<unsigned char>(drawn.values[i]) / 255.0;
  }
  return columns;
}

TEST(Font, ALetterBeginsWhereTheTextBeginsAndEndsByItsWidth) {
  for (const TextSize size : kSizes) {
    for (const std::string_view text : {"H", "M", "HH", "HHHHHHHHHHHH"}) {
      double inside = 0.0, all = 0.0, first = 1e9, last = -1e9;
      for (const auto& [column, covered] : ink_by_column(text, size)) {
        all += covered;
        if (column >= -1 && column <= text_width(text, size)) inside += covered;
        if (covered < 1.0) continue;
        first = std::min<double>(first, column);
        last = std::max<double>(last, column);
      }
      EXPECT_NEAR(inside, all, 1e-9) << text;
      // A stem is at most a quarter of a line from either end.
      EXPECT_LE(first, line_height(size) / 4) << text;
      EXPECT_GE(last, text_width(text, size) - 1 - line_height(size) / 4) << text;
    }
  }
}

TEST(Font, InkLiesAtTheSamePlaceInEverySize) {
  for (const std::string_view text : {"H", "l", "robot_1.yaml"}) {
    std::vector<double> middles;  // in pixels of the font's picture
    for (const TextSize size : kSizes) {
      double sum = 0.0, all = 0.0;
      for (const auto& [column, covered] : ink_by_column(text, size)) {
        sum += (column + 0.5) * static_cast<int>(size) * covered;
        all += covered;
      }
      middles.push_back(sum / all);
    }
    EXPECT_NEAR(middles[0], middles[1], 0.5) << text;
    EXPECT_NEAR(middles[0], middles[2], 0.5) << text;
  }
}

TEST(Font, LettersStandOnTheBaseline) {
  for (const TextSize size : kSizes) {
    const TextCoverage drawn = draw_text("HE", size);
    const auto inked = std::find_if(drawn.values.rbegin(), drawn.values.rend(),
                                    [](char value) { return static_cast<unsigned char>(value) > 127; });
    const int lowest = static_cast<int>(drawn.values.rend() - inked - 1) / drawn.width;
    EXPECT_NEAR(lowest + 1, baseline(size), 1);
  }
}

TEST(Font, WhatIsNoTextOrNotInTheFontIsTheReplacement) {
  const TextCoverage expected = draw_text("\ufffd", TextSize::small);
  for (const std::string_view text : {"\xff", "\xc3", "\x80", "\xc1\xa1", "\xe0\x81\xa1", "\xe4\xb8\x80",
                                      "\n", "\xe2\x80\xae", "\xf0\x9f\xa4\x96"}) {
    EXPECT_EQ(draw_text(text, TextSize::small).values, expected.values) << testing::PrintToString(text);
  }
  EXPECT_EQ(text_width("", TextSize::small), 0);
  EXPECT_EQ(ink("", TextSize::small), 0.0);
}

TEST(Font, FittedTextIsTheLongestEndThatFits) {
  const std::vector<std::string> letters{"a", "/", "W", ".", "ü", "я", "\xff", "_", "1"};
  std::mt19937 random(7);
  for (int i = 0; i < 300; ++i) {
    std::vector<std::string> text(random() % 30);
    for (std::string& letter : text) letter = letters[random() % letters.size()];
    const std::string whole = std::accumulate(text.begin(), text.end(), std::string());
    const TextSize size = kSizes[random() % 3];
    const int width = text_width("…", size) + static_cast<int>(random() % 400);
    const std::string fitted = fit_width(whole, size, width);
    EXPECT_LE(text_width(fitted, size), width);
    if (text_width(whole, size) <= width) {
      EXPECT_EQ(fitted, whole);
      continue;
    }
    std::string longest = "…";
    for (std::size_t kept = 0; kept <= text.size(); ++kept) {
      const std::string end =
          std::accumulate(text.end() - static_cast<long>(kept), text.end(), std::string());
      if (text_width("…" + end, size) <= width) longest = "…" + end;
    }
    EXPECT_EQ(fitted, longest);
  }
}

// make_font.py draws cells of 84 x 76 pixels, 32 in a row. A letter begins 8 pixels from the left of its
// cell; the first row of a cell is a bar as long as the way to the next letter.
constexpr int kAcross = 32, kCellWidth = 84, kCellHeight = 76, kBeside = 8;

struct Drawn {
  int advance = 0;
  std::vector<std::vector<int>> rows;  // below the bar
};

Drawn drawn_in_picture(int index) {
  static const PngImage picture = decode_png(kFontPicture);
  const auto gray = [&](int column, int row) {
    const int x = index % kAcross * kCellWidth + column, y = index / kAcross * kCellHeight + row;
    return static_cast<int>(picture.samples[static_cast<std::size_t>(y * picture.width + x)]);
  };
  Drawn drawn;
  for (int column = 0; column < kCellWidth; ++column) drawn.advance += gray(column, 0) != 0 ? 1 : 0;
  for (int row = 1; row < kCellHeight; ++row) {
    drawn.rows.emplace_back();
    for (int column = 0; column < kCellWidth; ++column) drawn.rows.back().push_back(gray(column, row));
  }
  return drawn;
}

/// The text by its places in the font, pixel by pixel: sums of what lies in each.
void expect_drawn(const std::string& text, const std::vector<int>& indexes) {
  for (const TextSize size : kSizes) {
    const int factor = static_cast<int>(size);
    const int left = -(kBeside + factor) / factor;  // of all that is looked at
    std::vector<Drawn> letters;
    int end = 0;
    for (const int index : indexes) {
      letters.push_back(drawn_in_picture(index));
      end += letters.back().advance;
    }
    const int width = (end + kCellWidth) / factor + 2 - left, height = kCellHeight / factor + 2;
    std::vector<int> expected(static_cast<std::size_t>(width * height), 0), found(expected.size(), 0);
    const auto place = [&](int column, int row) {
      return static_cast<std::size_t>(row * width + column - left);
    };
    int pen = -kBeside - left * factor;
    for (const Drawn& letter : letters) {
      for (int row = 0; row < kCellHeight - 1; ++row) {
        for (int column = 0; column < kCellWidth; ++column)
          expected[place((pen + column) / factor + left, row / factor)] +=
              letter.rows[static_cast<std::size_t>(row)][static_cast<std::size_t>(column)];
      }
      pen += letter.advance;
    }
    for (int& sum : expected) sum = std::min(255, sum / (factor * factor));
    EXPECT_EQ(text_width(text, size), (end + factor - 1) / factor);
    const TextCoverage covered = draw_text(text, size);
    EXPECT_EQ(covered.height, line_height(size));
    ASSERT_EQ(covered.values.size(), static_cast<std::size_t>(covered.width * covered.height));
    for (std::size_t i = 0; i < covered.values.size(); ++i) {
      const int value = static_cast<unsigned char>(covered.values[i]);
      const int column = static_cast<int>(i) % covered.width, row = static_cast<int>(i) / covered.width;
      if (value != 0) found.at(place(column + covered.left, row)) = value;
    }
    EXPECT_TRUE(found == expected) << text << ' ' << factor;
  }
}

TEST(Font, EachLetterIsDrawnAsItsPictureHasIt) {
  int index = 0;
  for (const auto& [first, last] : kFontCharacters) {
    for (char32_t character = first; character <= last; ++character, ++index) {
      if (character < 0x80 || character == first || character == last) expect_drawn(utf8(character), {index});
    }
  }
}

TEST(Font, LettersFollowEachOtherByTheirWidths) {
  const int a = 'a' - ' ';
  expect_drawn("", {});
  expect_drawn("jfj", {a + 9, a + 5, a + 9});
  expect_drawn("WWWWWWWWWW", std::vector<int>(10, 'W' - ' '));
  expect_drawn("-\u00a0~", {'-' - ' ', 0x7e - 0x20 + 1, '~' - ' '});
}

TEST(Font, LinesHaveTheHeightsOfTheirSizes) {
  // 75 pixels of the picture, of which 59 are above what letters stand on; a part of a pixel is a pixel.
  EXPECT_EQ(line_height(TextSize::large), 38);
  EXPECT_EQ(line_height(TextSize::small), 25);
  EXPECT_EQ(line_height(TextSize::tiny), 15);
  EXPECT_EQ(baseline(TextSize::large), 30);
  EXPECT_EQ(baseline(TextSize::small), 20);
  EXPECT_EQ(baseline(TextSize::tiny), 12);
}

TEST(Font, ReadsTheFirstAndTheLastCharactersOfEachLength) {
  const std::string none = draw_text("\ufffd", TextSize::small).values;
  const auto is_unknown = [&](std::string_view text) {
    return draw_text(text, TextSize::small).values == none;
  };
  EXPECT_FALSE(is_unknown("\x7e"));
  EXPECT_TRUE(is_unknown("\x7f"));       // not in the font
  EXPECT_FALSE(is_unknown("\xc2\xa0"));  // the first one of two bytes that the font has
  EXPECT_FALSE(is_unknown("\xc5\xbf"));
  EXPECT_TRUE(is_unknown("\xc6\x80"));
  EXPECT_FALSE(is_unknown("\xd1\x9f"));
  EXPECT_TRUE(is_unknown("\xd1\xa0"));
  EXPECT_FALSE(is_unknown("\xe2\x80\xa6"));
  EXPECT_TRUE(is_unknown("\xf0\x80\x81\x81"));  // an A of four bytes
  EXPECT_TRUE(is_unknown("\xe0\x82\xa0"));      // a blank of three
  // A character that is cut off is one unknown; what is behind it is read as usual.
  const int unknown = text_width("\ufffd", TextSize::large), letter = text_width("A", TextSize::large);
  const auto width = [](std::string_view text) { return text_width(text, TextSize::large); };
  EXPECT_NEAR(width("\xe2\x80"
                    "A"),
              unknown + letter, 1);
  EXPECT_NEAR(width("\xf0\x9f\xa4"
                    "A"),
              unknown + letter, 1);
  EXPECT_NEAR(width("\xf0\x9f\xa4\x96"
                    "A"),
              unknown + letter, 1);
  EXPECT_NEAR(width("\x80\x80"
                    "A"),
              2 * unknown + letter, 1);
  EXPECT_NEAR(width("\xc3\xa4"
                    "A"),
              width("\u00e4") + letter, 1);
}

TEST(Font, WhatFitsToThePixelIsNotCut) {
  for (const TextSize size : kSizes) {
    const std::string text = "folder/robot_1.yaml";
    const int width = text_width(text, size);
    EXPECT_EQ(fit_width(text, size, width), text);
    const std::string cut = fit_width(text, size, width - 1);
    EXPECT_EQ(cut.substr(0, 3), "\u2026");
    EXPECT_TRUE(text.ends_with(cut.substr(3)));
    // What is left over to the pixel, and a pixel less.
    const int least = text_width(cut, size);
    EXPECT_EQ(fit_width(text, size, least), cut);
    EXPECT_EQ(fit_width(text, size, least - 1), "\u2026" + cut.substr(4));
    EXPECT_EQ(fit_width(text, size, 0), "\u2026");
    EXPECT_EQ(fit_width("", size, 0), "");
  }
}

}  // namespace
}  // namespace gridmerge
