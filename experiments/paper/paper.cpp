// SPDX-License-Identifier: Apache-2.0
// The experiments of A. Birk and S. Carpin, "Merging occupancy grid maps from multiple robots" (2006), made
// again on maps of our own that are like theirs, and the same with the engine.
#include <fmt/format.h>

#include <charconv>
#include <cstdio>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "figures.hpp"
#include "io/atomic_file.hpp"
#include "table.hpp"

using namespace gridmerge::internal;

namespace {

using namespace gridmerge;

constexpr int kSide = 400;  // cells of the paper's maps
constexpr int kDraws = 10;
constexpr int kHardDraws = 30;  // of the hard pair, for what Delta says at its truth
constexpr int kLargeSide = 1000;
constexpr int kLargeDraws = 3;

constexpr const char* kUsage =
    "usage: gridmerge_paper fig N DIR    figure N, 1 to 11\n"
    "       gridmerge_paper table DIR    table I, and what the hard pair's measures are\n"
    "       gridmerge_paper all DIR      both, and all figures\n";

std::string make_tables() {
  const std::vector<paper::Draw> all = paper::make_draws(kSide, kHardDraws);
  const std::span<const paper::Draw> draws = std::span(all).first(kDraws);
  std::string text = "# The paper's experiments, made again\n\n## What the pairs share\n\n";
  text += paper::shared_cells(draws);
  text += fmt::format("\n## Table I, {} draws\n\n", kDraws) + paper::table_one(draws);
  text += fmt::format("\n## The hard pair, {} draws\n\n", kHardDraws) + paper::hard_pair_measures(all);
  return text + "\n## 1000 x 1000 cells\n\n" + paper::larger_maps(paper::make_draws(kLargeSide, kLargeDraws));
}

std::string make_all(const std::filesystem::path& folder) {
  std::string text = make_tables();
  for (int figure = paper::kFirstFigure; figure <= paper::kLastFigure; ++figure)
    text += fmt::format("\n{}", paper::make_figure(figure, folder));
  return text;
}

int run(int argc, char** argv) {
  const std::string_view command = argc > 1 ? argv[1] : "";
  const std::filesystem::path folder = argv[argc - 1];
  if (command == "fig" && argc == 4) {
    const std::string_view number = argv[2];
    int figure = 0;
    const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), figure);
    if (error != std::errc() || end != number.data() + number.size()) figure = 0;
    std::filesystem::create_directories(folder);
    std::fputs(paper::make_figure(figure, folder).c_str(), stdout);
    return 0;
  }
  if ((command != "table" && command != "all") || argc != 3) {
    std::fputs(kUsage, stderr);
    return 2;
  }
  std::filesystem::create_directories(folder);
  const std::string text = command == "table" ? make_tables() : make_all(folder);
  write_file_atomically(folder / (command == "table" ? "tables.md" : "report.md"), text);
  std::fputs(text.c_str(), stdout);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "gridmerge_paper: %s\n", error.what());
    return 1;
  }
}
