// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <filesystem>
#include <limits>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "grid/generators.hpp"
#include "gridmerge/grid/message_values.hpp"
#include "gridmerge/io/map_file.hpp"
#include "io/file_size_limit.hpp"
#include "io/png_builder.hpp"
#include "io/support.hpp"
#include "support/temporary_directory.hpp"

namespace gridmerge {
namespace {

using test::bytes;
using test::contains;
using test::TemporaryDirectory;

OccupancyGrid small_grid() {
  OccupancyGrid grid = make_grid(3, 2, 0.05, {-1.5, 2.25, 0.0}, Cell::free);
  grid.at(0, 0) = Cell::occupied;
  grid.at(2, 1) = Cell::unknown;
  return grid;
}

/// What is written beside the image of small_grid().
std::string yaml_of_small_grid(const std::string& image, const std::string& mode) {
  return "image: " + image + "\nmode: " + mode +
         "\n"
         "resolution: 0.05\n"
         "origin: [-1.5, 2.25, 0.0]\n"
         "negate: 0\n"
         "occupied_thresh: 0.65\n"
         "free_thresh: 0.196\n";
}

std::string error_of(const OccupancyGrid& grid, const std::filesystem::path& path) {
  return test::message_of<FileError>([&] { save_map(grid, path); });
}

TEST(SaveMap, WritesWhatMapServerReads) {
  const TemporaryDirectory directory;
  save_map(small_grid(), directory.file("merged.yaml"));
  EXPECT_EQ(test::read_file(directory.file("merged.yaml")), yaml_of_small_grid("merged.pgm", "trinary"));
  EXPECT_EQ(test::read_file(directory.file("merged.pgm")),
            "P5\n3 2\n255\n" + bytes({254, 254, 205, 0, 254, 254}));
  EXPECT_EQ(directory.names(), (std::vector<std::string>{"merged.pgm", "merged.yaml"}));
}

RC_GTEST_PROP(SaveMap, LoadsAgainToTheSameBits, (const OccupancyGrid& grid)) {
  const TemporaryDirectory directory;
  save_map(grid, directory.file("a.yaml"));
  const OccupancyGrid loaded = load_map(directory.file("a.yaml")).grid;
  RC_ASSERT(loaded.width == grid.width);
  RC_ASSERT(loaded.height == grid.height);
  RC_ASSERT(loaded.resolution == grid.resolution);
  RC_ASSERT(loaded.origin == grid.origin);
  RC_ASSERT(loaded.cells == grid.cells);
}

TEST(SaveProbabilityMap, WritesPercentsWithTheTopRowFirst) {
  const TemporaryDirectory directory;
  OccupancyGrid grid = small_grid();
  const float unknown = std::numeric_limits<float>::quiet_NaN();
  grid.probability = {1.0F, 0.0F, 0.37F, 1.5F, -0.5F, unknown};
  save_probability_map(grid, directory.file("fused.yaml"));
  EXPECT_EQ(test::read_file(directory.file("fused.yaml")), yaml_of_small_grid("fused.pgm", "raw"));
  EXPECT_EQ(test::read_file(directory.file("fused.pgm")),
            "P5\n3 2\n255\n" + bytes({100, 0, 255, 100, 0, 37}));
  EXPECT_EQ(directory.names(), (std::vector<std::string>{"fused.pgm", "fused.yaml"}));
}

constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();

// Cells and probabilities in one row.
OccupancyGrid row_of(const std::vector<std::pair<Cell, float>>& cells) {
  OccupancyGrid grid = make_grid(static_cast<int>(cells.size()), 1, 0.05);
  grid.cells.clear();
  for (const auto& [cell, probability] : cells) {
    grid.cells.push_back(cell);
    grid.probability.push_back(probability);
  }
  return grid;
}

struct SavedRow {
  OccupancyGrid loaded;
  std::string yaml;
};

SavedRow save_and_load(const OccupancyGrid& grid) {
  const TemporaryDirectory directory;
  save_probability_map(grid, directory.file("a.yaml"));
  return {load_map(directory.file("a.yaml")).grid, test::read_file(directory.file("a.yaml"))};
}

// The cells are the same, and the probabilities at most a percent off.
void expect_kept(const OccupancyGrid& grid, const std::string& thresholds) {
  const SavedRow saved = save_and_load(grid);
  EXPECT_EQ(saved.loaded.cells, grid.cells);
  EXPECT_TRUE(contains(saved.yaml, thresholds)) << saved.yaml;
  ASSERT_EQ(saved.loaded.probability.size(), grid.probability.size());
  for (std::size_t i = 0; i < grid.cells.size(); ++i) {
    if (std::isnan(grid.probability[i])) continue;
    EXPECT_NEAR(saved.loaded.probability[i], grid.probability[i], 0.01 + 1e-6) << i;
  }
}

const std::string kUsual = "occupied_thresh: 0.65\nfree_thresh: 0.196\n";

TEST(SaveProbabilityMap, KeepsCellsOnTheirSideOfTheUsualThresholds) {
  expect_kept(row_of({{Cell::free, 0.0F},
                      {Cell::free, 0.1959F},
                      {Cell::unknown, 0.1961F},
                      {Cell::unknown, 0.6499F},
                      {Cell::occupied, 0.6501F},
                      {Cell::occupied, 1.0F},
                      {Cell::unknown, kUnknown}}),
              kUsual);
}

TEST(SaveProbabilityMap, KeepsWhatMergingCallsFree) {
  expect_kept(
      row_of(
          {{Cell::free, 0.02F}, {Cell::free, 0.4988F}, {Cell::occupied, 0.5012F}, {Cell::unknown, kUnknown}}),
      "occupied_thresh: 0.51\nfree_thresh: 0.5\n");
}

TEST(SaveProbabilityMap, FindsThresholdsForWhateverTellsTheCellsApart) {
  expect_kept(row_of({{Cell::free, 0.25F}, {Cell::unknown, 0.5F}, {Cell::occupied, 0.625F}}),
              "occupied_thresh: 0.57\nfree_thresh: 0.37\n");
  // With room for one percentage between two others, or for none of the usual ones.
  expect_kept(row_of({{Cell::free, 0.4538F}, {Cell::unknown, 0.4576F}, {Cell::occupied, 0.4618F}}), "");
  expect_kept(row_of({{Cell::free, 0.645F}, {Cell::unknown, 0.648F}}), "");
  expect_kept(row_of({{Cell::unknown, 0.195F}, {Cell::occupied, 0.199F}}), "");
  // Without a cell of one kind.
  expect_kept(row_of({{Cell::unknown, 0.0F}, {Cell::unknown, 1.0F}}), "");
  expect_kept(row_of({{Cell::free, 1.0F}}), "");
  expect_kept(row_of({{Cell::occupied, 0.0F}}), "");
  expect_kept(row_of({{Cell::free, 0.0F}, {Cell::occupied, 0.001F}}), "");
  expect_kept(row_of({{Cell::free, 0.999F}, {Cell::occupied, 1.0F}}), "");
}

TEST(SaveProbabilityMap, GivesAKnownCellWithoutAProbabilityThatOfItsKind) {
  const OccupancyGrid loaded =
      save_and_load(row_of({{Cell::free, kUnknown}, {Cell::occupied, kUnknown}, {Cell::unknown, kUnknown}}))
          .loaded;
  EXPECT_EQ(loaded.cells, (std::vector<Cell>{Cell::free, Cell::occupied, Cell::unknown}));
  EXPECT_EQ(loaded.probability[0], 0.0F);
  EXPECT_EQ(loaded.probability[1], 1.0F);
  EXPECT_TRUE(std::isnan(loaded.probability[2]));
}

TEST(SaveProbabilityMap, KeepsProbabilitiesWhereNoThresholdsTellTheCellsApart) {
  // Free where it is more probably occupied; and no percentage lies between 0.301 and 0.304.
  for (const auto& cells : {std::vector<std::pair<Cell, float>>{{Cell::free, 0.7F}, {Cell::occupied, 0.3F}},
                            {{Cell::free, 0.301F}, {Cell::unknown, 0.302F}, {Cell::occupied, 0.304F}}}) {
    const OccupancyGrid grid = row_of(cells);
    const SavedRow saved = save_and_load(grid);
    EXPECT_TRUE(contains(saved.yaml, kUsual)) << saved.yaml;
    for (std::size_t i = 0; i < grid.cells.size(); ++i) {
      EXPECT_NEAR(saved.loaded.probability[i], grid.probability[i], 0.005) << i;
      EXPECT_EQ(saved.loaded.cells[i],
                cell_of_percentage(static_cast<int>(std::lround(100.0F * saved.loaded.probability[i]))));
    }
  }
}

RC_GTEST_PROP(SaveProbabilityMap, KeepsCellsThatFollowFromThresholdsTwoPercentApart, ()) {
  const double free = *rc::gen::inRange(0, 1000) / 1000.0,
               occupied = std::min(1.0, free + 0.02 + *rc::gen::inRange(0, 1000) / 1000.0);
  std::vector<std::pair<Cell, float>> cells;
  for (const int thousandths :
       *rc::gen::nonEmpty(rc::gen::container<std::vector<int>>(rc::gen::inRange(0, 1001)))) {
    const double probability = thousandths / 1000.0;
    const Cell cell = probability >= occupied ? Cell::occupied
                      : probability <= free   ? Cell::free
                                              : Cell::unknown;
    cells.emplace_back(cell, static_cast<float>(probability));
  }
  const OccupancyGrid grid = row_of(cells), loaded = save_and_load(grid).loaded;
  RC_ASSERT(loaded.cells == grid.cells);
  for (std::size_t i = 0; i < cells.size(); ++i)
    RC_ASSERT(std::abs(loaded.probability[i] - grid.probability[i]) <= 0.01F + 1e-6F);
}

TEST(SaveProbabilityMap, NeedsProbabilities) {
  const TemporaryDirectory directory;
  EXPECT_THROW(save_probability_map(small_grid(), directory.file("a.yaml")), std::invalid_argument);
  EXPECT_TRUE(directory.names().empty());
}

TEST(SaveMap, TakesAnyName) {
  const TemporaryDirectory directory;
  const std::string long_name = std::string(250, 'x') + ".yml";
  for (const std::string& name : {std::string("a.b.yaml"), std::string("ground floor #1: 'x'.yaml"),
                                  std::string("- 1.yml"), std::string("Küche.yaml"), std::string("null.yaml"),
                                  std::string("new\nline.yaml"), std::string("\r.yaml"), long_name}) {
    save_map(small_grid(), directory.file(name));
    EXPECT_EQ(load_map(directory.file(name)).grid.cells, small_grid().cells) << name;
  }
}

TEST(SaveMap, ReplacesWhatIsThere) {
  const TemporaryDirectory directory;
  save_map(make_grid(2, 2, 0.1), directory.file("a.yaml"));
  save_map(small_grid(), directory.file("a.yaml"));
  EXPECT_EQ(load_map(directory.file("a.yaml")).grid.cells, small_grid().cells);
}

TEST(SaveMap, RefusesOtherNames) {
  const TemporaryDirectory directory;
  for (const char* name : {"a.pgm", "a", "a.yaml.bak", ".yaml"}) {
    EXPECT_TRUE(contains(error_of(small_grid(), directory.file(name)), "must end in .yaml or .yml")) << name;
  }
  EXPECT_TRUE(directory.names().empty());
}

TEST(SaveMap, RefusesWhatCouldNotBeLoaded) {
  const TemporaryDirectory directory;
  OccupancyGrid grid = small_grid();
  grid.resolution = 1e-9;
  EXPECT_THROW(save_map(grid, directory.file("a.yaml")), std::invalid_argument);
  grid = small_grid();
  grid.cells[1] = static_cast<Cell>(100);
  EXPECT_THROW(save_map(grid, directory.file("a.yaml")), std::invalid_argument);
  grid = small_grid();
  grid.origin.x = 1.5 * kMaxOrigin;  // merged of maps far away, for example
  EXPECT_TRUE(contains(error_of(grid, directory.file("a.yaml")), "'origin' is further than"));
  grid = small_grid();
  EXPECT_TRUE(contains(error_of(grid, directory.file("\x02\x9c.yaml")), "cannot be written in YAML"));
  grid.cells.pop_back();
  EXPECT_THROW(save_map(grid, directory.file("a.yaml")), std::invalid_argument);
  EXPECT_TRUE(directory.names().empty());
}

TEST(SaveMap, NeedsADirectoryThatItCanWriteTo) {
  const TemporaryDirectory directory;
  EXPECT_TRUE(
      contains(error_of(small_grid(), directory.file("missing/a.yaml")), "No such file or directory"));
  directory.write("file", "x");
  EXPECT_TRUE(contains(error_of(small_grid(), directory.file("file/a.yaml")), "Not a directory"));
  EXPECT_EQ(directory.names(), std::vector<std::string>{"file"});
}

TEST(SaveMap, LeavesNeitherFileWhenTheYamlCannotBeWritten) {
  const TemporaryDirectory directory;
  std::filesystem::create_directory(directory.file("a.yaml"));
  EXPECT_TRUE(contains(error_of(small_grid(), directory.file("a.yaml")), "it names a directory"));
  EXPECT_EQ(directory.names(), std::vector<std::string>{"a.yaml"});
}

// Of a save_map that no disk space is left for.
void expect_nothing_left(const OccupancyGrid& grid, int limit) {
  const TemporaryDirectory directory;
  const std::string message =
      test::with_file_size_limit(limit, [&] { save_map(grid, directory.file("a.yaml")); });
  EXPECT_TRUE(contains(message, "File too large"));
  EXPECT_EQ(directory.names(), std::vector<std::string>{});
}

TEST(SaveMap, LeavesNothingOnAFullDisk) {
  expect_nothing_left(make_grid(100, 100, 0.05), 500);  // not even the image fits
  expect_nothing_left(small_grid(), 50);                // the image does, the YAML does not
}

TEST(SaveMap, KeepsTheOldMapOnAFullDisk) {
  const TemporaryDirectory directory;
  save_map(small_grid(), directory.file("a.yaml"));
  OccupancyGrid other = small_grid();
  other.at(1, 1) = Cell::occupied;
  test::with_file_size_limit(50, [&] { save_map(other, directory.file("a.yaml")); });
  EXPECT_EQ(load_map(directory.file("a.yaml")).grid.cells, small_grid().cells);
}

}  // namespace
}  // namespace gridmerge
