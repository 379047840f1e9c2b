// SPDX-License-Identifier: Apache-2.0
#include "figures.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iomanip>
#include <sstream>

namespace gridmerge::test {

namespace {

constexpr double kRelative = 1e-6;
constexpr int kDigits = 9;

void write(const std::string& path, const std::vector<FigureLine>& lines) {
  std::ofstream file(path);
  file << std::setprecision(kDigits);
  for (const FigureLine& line : lines) {
    file << line.name;
    for (const double figure : line.figures) file << '\t' << figure;
    file << '\n';
  }
}

}  // namespace

void expect_figures(const std::string& path, const std::vector<FigureLine>& lines) {
  if (std::getenv("GRIDMERGE_WRITE_FIGURES") != nullptr) write(path, lines);
  std::ifstream file(path);
  std::string text;
  for (const FigureLine& line : lines) {
    ASSERT_TRUE(std::getline(file, text)) << path << " has no line of " << line.name;
    std::istringstream columns(text);
    std::string name;
    std::getline(columns, name, '\t');
    ASSERT_EQ(name, line.name) << path;
    for (std::size_t i = 0; i < line.figures.size(); ++i) {
      double expected = 0.0;
      ASSERT_TRUE(columns >> expected) << line.name << " has no figure " << i;
      EXPECT_NEAR(line.figures[i], expected, kRelative * std::max(1.0, std::abs(expected)))
          << line.name << ", figure " << i;
    }
    EXPECT_FALSE(columns >> name) << line.name << " had more figures";
  }
  EXPECT_FALSE(std::getline(file, text)) << path << " has more lines";
}

}  // namespace gridmerge::test
