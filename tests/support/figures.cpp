// SPDX-License-Identifier: Apache-2.0
#include "figures.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <fstream>
#include <iomanip>
#include <locale>
#include <sstream>
#include <string_view>

namespace gridmerge::test {

namespace {

constexpr double kRelative = 1e-6, kAbsolute = 1e-8;
constexpr int kDigits = 10;

std::string text_of(const std::vector<FigureLine>& lines) {
  std::ostringstream text;
  text.imbue(std::locale::classic());
  text << std::setprecision(kDigits);
  for (const FigureLine& line : lines) {
    text << line.name;
    for (const Figure& figure : line.figures) text << '\t' << figure.name << '=' << figure.value;
    text << '\n';
  }
  return text.str();
}

bool is_whole(double value) {
  return std::floor(value) == value;
}

void expect_figure(const Figure& figure, const std::string& text, const std::string& line) {
  ASSERT_EQ(text.substr(0, text.find('=')), figure.name) << line;
  std::istringstream number(text.substr(text.find('=') + 1));
  number.imbue(std::locale::classic());
  double expected = 0.0;
  ASSERT_TRUE(number >> expected) << line << ", " << figure.name;
  if (is_whole(expected) && is_whole(figure.value)) {
    EXPECT_EQ(figure.value, expected) << line << ", " << figure.name;
  } else {
    EXPECT_NEAR(figure.value, expected, kRelative * std::abs(expected) + kAbsolute)
        << line << ", " << figure.name;
  }
}

}  // namespace

void expect_figures(const std::string& path, const std::vector<FigureLine>& lines) {
  const char* const write = std::getenv("GRIDMERGE_WRITE_FIGURES");
  if (write != nullptr && std::string_view(write) == "1") {
    std::ofstream file(path);
    file << text_of(lines);
    ASSERT_TRUE(file.flush()) << path;
    GTEST_SKIP() << "wrote " << path;
  }
  std::ifstream file(path);
  std::string text;
  for (const FigureLine& line : lines) {
    ASSERT_TRUE(std::getline(file, text)) << path << " has no line of " << line.name;
    std::istringstream columns(text);
    ASSERT_TRUE(std::getline(columns, text, '\t'));
    ASSERT_EQ(text, line.name) << path;
    for (const Figure& figure : line.figures) {
      ASSERT_TRUE(std::getline(columns, text, '\t')) << line.name << " has no " << figure.name;
      expect_figure(figure, text, line.name);
    }
    EXPECT_FALSE(std::getline(columns, text, '\t')) << line.name << " had more figures";
  }
  EXPECT_FALSE(std::getline(file, text)) << path << " has more lines";
}

Figures with_pose(const SE2& T, const Figures& others) {
  Figures all{{"x", T.x}, {"y", T.y}, {"theta", T.theta}};
  all.insert(all.end(), others.begin(), others.end());
  return all;
}

Figures figures_of(const OccupancyGrid& grid) {
  const CellCounts counts = count_cells(grid);
  double places = 0.0, probability = 0.0;
  for (int row = 0; row < grid.height; ++row) {
    for (int column = 0; column < grid.width; ++column) {
      const Cell cell = grid.at(column, row);
      if (cell == Cell::unknown) continue;
      if (cell == Cell::occupied) places += 3.0 * row + column;
      probability += static_cast<double>(grid.probability[grid.index(column, row)]);
    }
  }
  return {{"width", static_cast<double>(grid.width)},
          {"height", static_cast<double>(grid.height)},
          {"resolution", grid.resolution},
          {"origin_x", grid.origin.x},
          {"origin_y", grid.origin.y},
          {"occupied", static_cast<double>(counts.occupied)},
          {"free", static_cast<double>(counts.free)},
          {"places", places},
          {"probability", probability}};
}

}  // namespace gridmerge::test
