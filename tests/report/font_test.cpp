// SPDX-License-Identifier: Apache-2.0
#include "report/font.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <random>
#include <vector>

#include "report/font_characters.hpp"

namespace gridmerge {

using namespace internal;
namespace {

constexpr TextSize kSizes[] = {TextSize::large, TextSize::small, TextSize::tiny};

std::string utf8(char32_t character) {
  const auto byte = [](char32_t bits) { return static_cast<char>(bits); };
  if (character < 0x80) return {byte(character)};
  if (character < 0x800) return {byte(0xC0 | character >> 6), byte(0x80 | (character & 0x3F))};
  return {byte(0xE0 | character >> 12), byte(0x80 | (character >> 6 & 0x3F)),
          byte(0x80 | (character & 0x3F))};
}

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

}  // namespace
}  // namespace gridmerge
