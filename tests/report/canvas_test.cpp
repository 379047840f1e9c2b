// SPDX-License-Identifier: Apache-2.0
#include "report/canvas.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "report/font_characters.hpp"
#include "report/style.hpp"
#include "report/utf8.hpp"

namespace gridmerge {

using namespace internal;
namespace {

using test::utf8;

constexpr Colour kPaper{1, 2, 3}, kRed{200, 0, 0}, kBlue{0, 0, 200};

Colour at(const Canvas& canvas, int x, int y) {
  const std::size_t sample =
      (static_cast<std::size_t>(y) * static_cast<std::size_t>(canvas.width()) + static_cast<std::size_t>(x)) *
      3;
  const std::vector<std::uint8_t>& samples = canvas.image().samples;
  return {samples[sample], samples[sample + 1], samples[sample + 2]};
}

/// A row a text: '#' is red, '+' is blue, '.' is neither.
std::vector<std::string> drawn(const Canvas& canvas) {
  std::vector<std::string> rows;
  for (int y = 0; y < canvas.height(); ++y) {
    rows.emplace_back();
    for (int x = 0; x < canvas.width(); ++x) {
      const Colour colour = at(canvas, x, y);
      rows.back() += colour == kRed ? '#' : colour == kBlue ? '+' : '.';
      if (rows.back().back() == '.') {
        EXPECT_EQ(colour, kPaper);
      }
    }
  }
  return rows;
}

using Rows = std::vector<std::string>;

TEST(Canvas, FillsWhatLiesInIt) {
  Canvas canvas(5, 4, kPaper);
  EXPECT_EQ(canvas.width(), 5);
  EXPECT_EQ(canvas.height(), 4);
  canvas.fill(1, 2, 3, 1, kRed);
  EXPECT_EQ(drawn(canvas), (Rows{".....", ".....", ".###.", "....."}));
  canvas.fill(-2, -1, 3, 2, kBlue);
  canvas.fill(4, 3, 9, 9, kBlue);
  EXPECT_EQ(drawn(canvas), (Rows{"+....", ".....", ".###.", "....+"}));
  canvas.fill(5, 0, 3, 4, kRed);
  canvas.fill(0, 4, 5, 3, kRed);
  canvas.fill(2, 0, 0, 4, kRed);
  EXPECT_EQ(drawn(canvas), (Rows{"+....", ".....", ".###.", "....+"}));
}

TEST(Canvas, DrawsAnotherOneAsFarAsItLiesInIt) {
  Canvas stamp(3, 2, kRed);
  stamp.fill(2, 1, 1, 1, kBlue);
  const auto stamped = [&](int x, int y) {
    Canvas canvas(4, 3, kPaper);
    canvas.draw(x, y, stamp);
    return drawn(canvas);
  };
  EXPECT_EQ(stamped(1, 1), (Rows{"....", ".###", ".##+"}));
  EXPECT_EQ(stamped(-2, -1), (Rows{"+...", "....", "...."}));
  EXPECT_EQ(stamped(3, 2), (Rows{"....", "....", "...#"}));
  EXPECT_EQ(stamped(-1, 1), (Rows{"....", "##..", "#+.."}));
  for (const auto& [x, y] : {std::pair(4, 0), {-3, 0}, {0, 3}, {0, -2}})
    EXPECT_EQ(stamped(x, y), (Rows{"....", "....", "...."})) << x << ' ' << y;
}

/// How many pixels are not paper.
int inked(const Canvas& canvas) {
  int count = 0;
  for (int y = 0; y < canvas.height(); ++y) {
    for (int x = 0; x < canvas.width(); ++x) count += at(canvas, x, y) == kPaper ? 0 : 1;
  }
  return count;
}

TEST(Canvas, OfATextAsMuchIsWrittenAsLiesInIt) {
  Canvas whole(100, 60, kPaper);
  whole.write(30, 10, TextSize::large, "M", kRed);
  EXPECT_GT(inked(whole), 100);
  // The same, cut at each side: what is left is what was there.
  for (const auto& [left, top, width, height] :
       {std::array{40, 0, 60, 60}, {0, 22, 100, 38}, {0, 0, 40, 60}, {0, 0, 100, 30}}) {
    Canvas part(width, height, kPaper);
    part.write(30 - left, 10 - top, TextSize::large, "M", kRed);
    EXPECT_GT(inked(part), 20);
    EXPECT_LT(inked(part), inked(whole));
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x)
        ASSERT_EQ(at(part, x, y), at(whole, x + left, y + top)) << x << ' ' << y;
    }
  }
}

/// Each pixel by what the font says of it alone.
TEST(Canvas, WritesEachPixelByHowMuchOfItIsCovered) {
  constexpr int kLeft = 7, kTop = 3;
  for (const TextSize size : {TextSize::large, TextSize::small, TextSize::tiny}) {
    for (const CharacterRange& range : kFontCharacters) {
      for (char32_t character = range.first; character <= range.last; ++character) {
        const std::string text = utf8(character);
        const TextCoverage coverage = draw_text(text, size);
        Canvas canvas(kLeft + coverage.width + 4, kTop + coverage.height + 2, kPaper);
        canvas.write(kLeft, kTop, size, text, kRed);
        int wrong = 0;
        for (int y = 0; y < canvas.height(); ++y) {
          for (int x = 0; x < canvas.width(); ++x) {
            const int column = x - kLeft - coverage.left, row = y - kTop;
            int covered = 0;
            if (column >= 0 && column < coverage.width && row >= 0 && row < coverage.height)
              covered = static_cast<unsigned char>(
                  coverage.values[static_cast<std::size_t>(row * coverage.width + column)]);
            wrong += at(canvas, x, y) == mix(kPaper, kRed, covered / 255.0) ? 0 : 1;
          }
        }
        ASSERT_EQ(wrong, 0) << text << ' ' << static_cast<int>(size);
      }
    }
  }
}

TEST(Canvas, OfNoHeightOrWidthIsEmpty) {
  for (const auto& [width, height] : {std::pair(0, 3), {3, 0}, {0, 0}}) {
    Canvas canvas(width, height, kPaper);
    canvas.fill(0, 0, 2, 2, kRed);
    canvas.write(0, 0, TextSize::tiny, "M", kRed);
    EXPECT_TRUE(canvas.image().samples.empty());
    Canvas other(2, 2, kPaper);
    other.draw(0, 0, canvas);
    EXPECT_EQ(drawn(other), (Rows{"..", ".."}));
  }
}

TEST(Colours, AreMixedByTheirShares) {
  EXPECT_EQ(mix({0, 100, 200}, {100, 0, 201}, 0.0), (Colour{0, 100, 200}));
  EXPECT_EQ(mix({0, 100, 200}, {100, 0, 201}, 1.0), (Colour{100, 0, 201}));
  EXPECT_EQ(mix({0, 100, 200}, {100, 0, 201}, 0.254), (Colour{25, 75, 200}));
  EXPECT_EQ(mix({0, 0, 0}, {255, 255, 255}, 0.5), (Colour{128, 128, 128}));
}

}  // namespace
}  // namespace gridmerge
