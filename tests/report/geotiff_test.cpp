// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include "gridmerge/merge/fuse.hpp"
#include "report/interchange.hpp"
#include "report/interchange_support.hpp"
#include "report/tiff_pyramid.hpp"
#include "report/tiff_reader.hpp"
#include "support/temporary_directory.hpp"

namespace gridmerge {

using namespace internal;
using namespace test;
namespace {

/// Value by value what fuse() gives.
void expect_fused(const TiffPicture& picture, const OccupancyGrid& fused) {
  ASSERT_EQ(picture.width(), fused.width);
  ASSERT_EQ(picture.height(), fused.height);
  EXPECT_NEAR(picture.real(33922, 3), fused.origin.x, 1e-9);
  EXPECT_NEAR(picture.real(33922, 4), fused.origin.y + fused.height * fused.resolution, 1e-9);
  EXPECT_EQ(picture.real(33550, 0), fused.resolution);
  for (int row = 0; row < fused.height; ++row) {
    for (int column = 0; column < fused.width; ++column) {
      const int value =
          picture.pixels[static_cast<std::size_t>((fused.height - 1 - row) * fused.width + column)];
      const Cell cell = fused.at(column, row);
      ASSERT_EQ(value == TiffPyramid::kUnknown, cell == Cell::unknown);
      if (cell == Cell::unknown) continue;
      ASSERT_EQ(value > 50, cell == Cell::occupied);
      ASSERT_NE(value, 50);
      ASSERT_NEAR(value, 100.0 * static_cast<double>(fused.probability[fused.index(column, row)]), 1.0);
    }
  }
}

/// A fleet in two components.
Fleet two_fleets() {
  Fleet fleet(9);
  std::vector<Component>& components = fleet.result.components;
  std::vector<Member>& members = components.front().members;
  components.push_back({{members.begin() + 4, members.end()}, {}});
  components.front().members.resize(4);
  return fleet;
}

TEST(GeoTiff, IsTheMergedMapOfEachComponent) {
  const TemporaryDirectory directory;
  Fleet fleet = two_fleets();
  ASSERT_EQ(fleet.result.components.size(), 2u);
  fleet.names[fleet.result.components[0].members[0].map] = "a|b\xc3\xa4.yaml";
  const auto files = write_export(ExportFormat::geotiff, directory.file("m.tif"), {}, fleet.named());
  ASSERT_EQ(files.size(), fleet.result.components.size());
  EXPECT_EQ(files[0].filename(), "m.tif");
  EXPECT_EQ(files[1].filename(), "m_2.tif");
  EXPECT_EQ(directory.names().size(), files.size());
  for (std::size_t i = 0; i < files.size(); ++i) {
    std::vector<PlacedMap> placed;
    double finest = 1e9;
    for (const Member& member : fleet.result.components[i].members) {
      placed.push_back({&fleet.maps[member.map], member.T_component_map});
      finest = std::min(finest, fleet.maps[member.map].resolution);
    }
    const std::vector<TiffPicture> pictures = TiffReader(read_file(files[i])).pictures();
    expect_fused(pictures.at(0), fuse(placed, finest).grid);
    EXPECT_TRUE(contains(pictures[0].texts.at(34737), i == 0 ? "a_b__.yaml" : "frame of"));
  }
}

// Where one has more columns than are fused at once, and more rows than a tile.
TEST(GeoTiff, IsWholeWherePartsOfItMeet) {
  const TemporaryDirectory directory;
  std::mt19937 random(5);
  std::vector<OccupancyGrid> maps;
  for (int i = 0; i < 2; ++i) {
    maps.push_back(make_grid(40, 3, 0.5));
    for (Cell& cell : maps.back().cells) cell = static_cast<Cell>(random() % 3);
    maps.back().cells.front() = maps.back().cells.back() = Cell::occupied;
  }
  const std::vector<std::string> names{"a", "b"};
  // The second map lies in the columns 8172 to 8211, and in the rows 500 to 539 if it is turned.
  const std::vector<SE2> places{{8172 * 0.5, 0.0, 0.0}, {1.5, 500 * 0.5, std::acos(-1.0) / 2}};
  for (const SE2& place : places) {
    MergeResult result;
    result.components.push_back({{{0, {}}, {1, place}}, {}});
    write_export(ExportFormat::geotiff, directory.file("m.tif"), {}, {names, maps, result});
    const std::vector<TiffPicture> pictures = TiffReader(read_file(directory.file("m.tif"))).pictures();
    expect_fused(pictures.at(0), fuse({{&maps[0], {}}, {&maps[1], place}}, 0.5).grid);
  }
}

TEST(GeoTiff, IsAsLargeAsItHasToBe) {
  const TemporaryDirectory directory;
  std::vector<OccupancyGrid> maps;
  for (int i = 0; i < 2; ++i) {
    maps.push_back(make_grid(60, 40, 0.05, {}, Cell::free));
    maps.back().at(5 + i, 7) = Cell::occupied;
  }
  MergeResult result;
  result.components.push_back({{{0, {}}, {1, {30.0, 27.0, 0.0}}}, {}});
  const std::vector<std::string> names{"a", "b"};
  write_export(ExportFormat::geotiff, directory.file("m.tif"), {}, {names, maps, result});
  const std::vector<TiffPicture> pictures = TiffReader(read_file(directory.file("m.tif"))).pictures();
  ASSERT_EQ(pictures.at(0).width(), 660);
  ASSERT_EQ(pictures.at(0).height(), 580);
  const auto at = [&](int column, int row) {
    return pictures[0].pixels[static_cast<std::size_t>(579 - row) * 660 + static_cast<std::size_t>(column)];
  };
  EXPECT_EQ(at(5, 7), 85);
  EXPECT_EQ(at(6, 7), 35);
  EXPECT_EQ(at(606, 547), 85);
  EXPECT_EQ(at(300, 280), TiffPyramid::kUnknown);
  ASSERT_EQ(pictures.size(), 2u);
  EXPECT_EQ(*std::max_element(pictures[1].pixels.begin(), pictures[1].pixels.end(),
                              [](int a, int b) { return a % 255 < b % 255; }),
            85)
      << "walls stay";

  // One that is too large even so.
  result.components[0].members[1].T_component_map = {2e4, 2e4, 0.0};
  EXPECT_TRUE(
      contains(message_of<FileError>([&] {
                 write_export(ExportFormat::geotiff, directory.file("n.tif"), {}, {names, maps, result});
               }),
               "n.tif: is not written: the merged map would exceed 2^36 cells"));
  EXPECT_EQ(directory.names(), std::vector<std::string>{"m.tif"});
}

TEST(GeoTiff, FilesOfAnEarlierExportThatHadMoreAreRemoved) {
  const TemporaryDirectory directory;
  const Fleet two = two_fleets(), one(9);
  const auto write = [&](const std::string& name, const Fleet& fleet,
                         const std::vector<std::filesystem::path>& inputs = {}) {
    return write_export_files(ExportFormat::geotiff, directory.file(name), inputs, fleet.named());
  };
  EXPECT_TRUE(write("m.tif", two).removed.empty());
  write("m_3.tif", one);  // an export of its own
  std::filesystem::copy_file(directory.file("m_2.tif"), directory.file("m_4.tif"));
  std::filesystem::copy_file(directory.file("m_2.tif"), directory.file("other_2.tif"));
  const std::vector<std::string> mine{"m.tif", "m_3.tif", "m_4.tif", "other_2.tif"};
  const std::string first = read_file(directory.file("m.tif"));
  EXPECT_TRUE(contains(message_of<FileError>([&] { write("m.tif", one, {directory.file("m_2.tif")}); }),
                       "m_2.tif: is an input"));
  EXPECT_TRUE(read_file(directory.file("m.tif")) == first);
  const ExportedFiles files = write("m.tif", one);
  EXPECT_EQ(files.written, std::vector<std::filesystem::path>{directory.file("m.tif")});
  EXPECT_EQ(files.removed, std::vector<std::filesystem::path>{directory.file("m_2.tif")});
  EXPECT_EQ(directory.names(), mine);
  EXPECT_FALSE(read_file(directory.file("m.tif")) == first);
}

TEST(GeoTiff, FollowsLinksToOtherFolders) {
  const TemporaryDirectory directory;
  directory.write("there/n.tif", "old");
  std::filesystem::create_symlink("there/n.tif", directory.file("m.tif"));
  const Fleet fleet = two_fleets();
  write_export(ExportFormat::geotiff, directory.file("m.tif"), {}, fleet.named());
  EXPECT_TRUE(std::filesystem::is_symlink(directory.file("m.tif")));
  EXPECT_EQ(read_file(directory.file("there/n.tif")).substr(0, 2), "II");
  EXPECT_EQ(read_file(directory.file("m_2.tif")).substr(0, 2), "II");
  EXPECT_EQ(directory.names(), (std::vector<std::string>{"m.tif", "m_2.tif", "there"}));
}

TEST(GeoTiff, NoneOfItsFilesReplacesAnInput) {
  const TemporaryDirectory directory;
  const Fleet fleet = two_fleets();
  const std::string second = directory.write("m_2.tif", "an input");
  const std::string error = message_of<FileError>(
      [&] { write_export(ExportFormat::geotiff, directory.file("m.tif"), {second}, fleet.named()); });
  EXPECT_TRUE(contains(error, "m_2.tif: is an input")) << error;
  EXPECT_EQ(directory.names(), std::vector<std::string>{"m_2.tif"});
}

}  // namespace
}  // namespace gridmerge
