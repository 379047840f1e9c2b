// SPDX-License-Identifier: Apache-2.0
// Good map files, from the disk to the grid.
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <clocale>
#include <filesystem>
#include <fstream>
#include <locale>
#include <string>
#include <thread>

#include "gridmerge/io/map_file.hpp"
#include "io/image_builder.hpp"
#include "io/png_builder.hpp"
#include "support/temporary_directory.hpp"

namespace gridmerge {
namespace {

using test::bytes;
using test::TemporaryDirectory;
using Cells = std::vector<Cell>;

constexpr Cell kUnknown = Cell::unknown, kFree = Cell::free, kOccupied = Cell::occupied;

std::string yaml_with_image(const std::string& image) {
  return "image: " + image +
         "\nresolution: 0.05\norigin: [-1.0, 2.0, 0.5]\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: "
         "0.196\n";
}

const std::string kPgm = "P5\n# a comment\n2 2\n255\n" + bytes({0, 205, 254, 254});
const Cells kCells{kFree, kFree, kOccupied, kUnknown};  // of kPgm, bottom row first

TEST(LoadMap, ReadsYamlAndPgm) {
  const TemporaryDirectory directory;
  directory.write("a.pgm", kPgm);
  const LoadedMap map = load_map(directory.write("a.yaml", yaml_with_image("a.pgm")));
  EXPECT_EQ(map.grid.width, 2);
  EXPECT_EQ(map.grid.height, 2);
  EXPECT_EQ(map.grid.resolution, 0.05);
  EXPECT_EQ(map.grid.origin, (SE2{-1.0, 2.0, 0.5}));
  EXPECT_EQ(map.grid.cells, kCells);
  EXPECT_TRUE(map.grid.probability.empty());
  EXPECT_TRUE(map.warnings.empty());
}

TEST(LoadMap, ReadsPng) {
  const TemporaryDirectory directory;
  directory.write("a.png",
                  test::PngBuilder{.width = 2, .height = 2, .rows = bytes({0, 205, 254, 254})}.build());
  EXPECT_EQ(load_map(directory.write("a.yaml", yaml_with_image("a.png"))).grid.cells, kCells);
}

TEST(LoadMap, TellsImagesByTheirContent) {
  const TemporaryDirectory directory;
  directory.write("a.png", kPgm);
  EXPECT_EQ(load_map(directory.write("a.yaml", yaml_with_image("a.png"))).grid.cells, kCells);
  directory.write("a", kPgm);
  EXPECT_EQ(load_map(directory.write("a.txt", yaml_with_image("a"))).grid.cells, kCells);
}

TEST(LoadMap, KeepsProbabilitiesOfScaleAndRaw) {
  const TemporaryDirectory directory;
  directory.write("a.pgm", "P2 2 1 255\n0 100\n");
  const LoadedMap map = load_map(directory.write("a.yaml", yaml_with_image("a.pgm") + "mode: raw\n"));
  EXPECT_EQ(map.grid.probability, (std::vector<float>{0.0f, 1.0f}));
}

TEST(LoadMap, FindsTheImageBesideTheYaml) {
  const TemporaryDirectory directory;
  directory.write("maps/images/a.pgm", kPgm);
  EXPECT_EQ(load_map(directory.write("maps/a.yaml", yaml_with_image("images/a.pgm"))).grid.cells, kCells);
  EXPECT_EQ(load_map(directory.write("b.yaml", yaml_with_image("maps/../maps/images/a.pgm"))).grid.cells,
            kCells);
}

TEST(LoadMap, FindsTheImageBesideAYamlInTheWorkingDirectory) {
  const TemporaryDirectory directory;
  directory.write("a.pgm", kPgm);
  directory.write("a.yaml", yaml_with_image("a.pgm"));
  const auto before = std::filesystem::current_path();
  std::filesystem::current_path(directory.path());
  const Cells cells = load_map("a.yaml").grid.cells;
  std::filesystem::current_path(before);
  EXPECT_EQ(cells, kCells);
}

TEST(LoadMap, TakesAbsoluteImagePathsAndSpaces) {
  const TemporaryDirectory directory, elsewhere;
  const std::string image = directory.write("my maps/ground floor #1.pgm", kPgm);
  EXPECT_EQ(load_map(elsewhere.write("a.yaml", yaml_with_image("'" + image + "'"))).grid.cells, kCells);
  EXPECT_EQ(
      load_map(directory.write("a.yaml", yaml_with_image("\"my maps/ground floor #1.pgm\""))).grid.cells,
      kCells);
}

TEST(LoadMap, OfAnImagePathOfAnotherMachineTakesTheFileBesideTheYaml) {
  const TemporaryDirectory directory;
  const std::string beside = directory.write("a.pgm", kPgm);
  for (const char* path : {"/nowhere/home/robot/maps/a.pgm", "~/maps/a.pgm", "maps/a.pgm", "C:\\maps\\a.pgm",
                           "/dev/null/a.pgm"}) {
    const std::string yaml = directory.write("a.yaml", yaml_with_image(path));
    const LoadedMap map = load_map(yaml);
    EXPECT_EQ(map.grid.cells, kCells) << path;
    ASSERT_EQ(map.warnings.size(), 1u) << path;
    EXPECT_EQ(map.warnings[0].kind, MapWarningKind::image_elsewhere);
    EXPECT_NE(map.warnings[0].text.find(path), std::string::npos) << map.warnings[0].text;
    EXPECT_EQ(map.files, (std::vector<std::filesystem::path>{yaml, beside}));
    EXPECT_EQ(map_files(yaml), map.files);
  }
}

TEST(LoadMap, TheImageAtItsPathComesFirst) {
  const TemporaryDirectory directory;
  directory.write("a.pgm", "P2 1 1 255 0");
  directory.write("maps/a.pgm", kPgm);
  const LoadedMap map = load_map(directory.write("a.yaml", yaml_with_image("maps/a.pgm")));
  EXPECT_EQ(map.grid.cells, kCells);
  EXPECT_TRUE(map.warnings.empty());
}

TEST(LoadMap, ReadsPpmBmpAndJpeg) {
  const TemporaryDirectory directory;
  const std::string yaml = directory.write("a.yaml", yaml_with_image("a.img"));
  directory.write("a.img", "P3 2 2 255  0 0 0  205 205 205  254 254 254  254 254 254");
  EXPECT_EQ(load_map(yaml).grid.cells, kCells);
  directory.write("a.img", test::gray_bmp(2, 2, {0, 205, 254, 254}));
  EXPECT_EQ(load_map(yaml).grid.cells, kCells);
  std::vector<std::uint8_t> halves(32 * 16, 254);  // a block and more of each: JPEG blurs what is smaller
  for (std::size_t i = 0; i < halves.size(); ++i) halves[i] = i % 32 < 16 ? 0 : 205;
  directory.write("a.img", test::gray_jpeg(32, 16, halves));
  const OccupancyGrid grid = load_map(yaml).grid;
  EXPECT_EQ(grid.width, 32);
  EXPECT_EQ(grid.at(3, 3), kOccupied);
  EXPECT_EQ(grid.at(28, 3), kUnknown);
}

TEST(LoadMap, ReadsPicturesOfWhichMuchIsSaid) {
  const TemporaryDirectory directory;
  const std::string yaml = directory.write("a.yaml", yaml_with_image("a.img"));
  std::string image = test::gray_jpeg(32, 16, std::vector<std::uint8_t>(32 * 16, 254));
  const std::string part = std::string("\xff\xe1\xff\xff", 4) + std::string(65533, 'x');  // as a camera's
  std::string parts;
  for (int i = 0; i < 40; ++i) parts += part;
  image.insert(2, parts);
  directory.write("a.img", image);
  EXPECT_EQ(load_map(yaml).grid.width, 32);

  constexpr std::size_t kHeader = 8 + 4 + 4 + 13 + 4;  // a signature, and the chunk that tells the size
  std::string png = test::PngBuilder{.width = 2, .height = 2, .rows = bytes({0, 205, 254, 254})}.build();
  png.insert(kHeader,
             test::png_chunk("tEXt", std::string("Comment\0", 8) + std::string(std::size_t{9} << 20, 'x')));
  directory.write("a.img", png);
  EXPECT_EQ(load_map(yaml).grid.cells, kCells);
}

TEST(LoadMap, ReadsThresholdsToTheLetterOnRequest) {
  const TemporaryDirectory directory;
  directory.write("a.pgm", kPgm);
  std::string text = yaml_with_image("a.pgm");
  text.replace(text.find("0.196"), 5, "0.25");
  const std::string yaml = directory.write("a.yaml", text);
  EXPECT_EQ(load_map(yaml).grid.cells, kCells);
  EXPECT_EQ(load_map(yaml, {.literal_thresholds = true}).grid.cells, (Cells{kFree, kFree, kOccupied, kFree}));
}

TEST(LoadMap, TakesABareImageWithAResolution) {
  const TemporaryDirectory directory;
  const LoadedMap map = load_map(directory.write("a.pgm", kPgm), {.resolution = 0.1});
  EXPECT_EQ(map.grid.cells, kCells);
  EXPECT_EQ(map.grid.resolution, 0.1);
  EXPECT_EQ(map.grid.origin, SE2{});
  EXPECT_TRUE(map.warnings.empty());
}

TEST(LoadMap, AYamlKnowsItsResolutionBetter) {
  const TemporaryDirectory directory;
  directory.write("a.pgm", kPgm);
  EXPECT_EQ(
      load_map(directory.write("a.yaml", yaml_with_image("a.pgm")), {.resolution = 0.1}).grid.resolution,
      0.05);
}

TEST(LoadMap, TakesASingleCell) {
  const TemporaryDirectory directory;
  const LoadedMap map = load_map(directory.write("a.pgm", "P2 1 1 255 0"), {.resolution = 1.0});
  EXPECT_EQ(map.grid.cells, Cells{kOccupied});
}

TEST(LoadMap, TakesAsManyCellsAsAllowed) {
  const TemporaryDirectory directory;
  directory.write("a.pgm", kPgm);
  const std::string yaml = directory.write("a.yaml", yaml_with_image("a.pgm"));
  EXPECT_NO_THROW(load_map(yaml, {.max_cells = 4}));
  EXPECT_THROW(load_map(yaml, {.max_cells = 3}), FileError);
  EXPECT_NO_THROW(load_map(yaml, {.max_cells = std::numeric_limits<std::size_t>::max()}));
}

TEST(LoadMap, ReadsFromAPipe) {
  const TemporaryDirectory directory;
  const std::string pipe = directory.file("pipe");
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  std::thread writer([&] { std::ofstream(pipe, std::ios::binary) << kPgm; });
  const LoadedMap map = load_map(pipe, {.resolution = 0.1});
  writer.join();
  EXPECT_EQ(map.grid.cells, kCells);
}

// Numbers with commas for points, as a German locale has them; made here, as none may be installed.
class CommaPoint : public std::numpunct<char> {
  char do_decimal_point() const override { return ','; }
  char do_thousands_sep() const override { return '.'; }
  std::string do_grouping() const override { return "\3"; }
};

TEST(LoadMap, DoesNotDependOnTheLocale) {
  const TemporaryDirectory directory;
  const std::locale before = std::locale::global(std::locale(std::locale::classic(), new CommaPoint));
  OccupancyGrid grid = make_grid(1500, 1, 1.0 / 3.0, {-1234.5, 0.1, 0.0}, kFree);
  save_map(grid, directory.file("a.yaml"));
  const OccupancyGrid loaded = load_map(directory.file("a.yaml")).grid;
  std::locale::global(before);
  EXPECT_EQ(loaded.width, 1500);
  EXPECT_EQ(loaded.resolution, grid.resolution);
  EXPECT_EQ(loaded.origin, grid.origin);
}

TEST(LoadMap, TellsWhichFilesItRead) {
  const TemporaryDirectory directory;
  const std::string image = directory.write("maps/images/a.pgm", kPgm);
  const std::string yaml = directory.write("maps/a.yaml", yaml_with_image("images/a.pgm"));
  EXPECT_EQ(load_map(yaml).files, (std::vector<std::filesystem::path>{yaml, image}));
  EXPECT_EQ(map_files(yaml), load_map(yaml).files);
  EXPECT_EQ(load_map(image, {.resolution = 0.1}).files, std::vector<std::filesystem::path>{image});
  EXPECT_EQ(map_files(image), std::vector<std::filesystem::path>{image});
}

TEST(MapFiles, NeedNoImageButAYaml) {
  const TemporaryDirectory directory;
  const std::string yaml = directory.write("a.yaml", yaml_with_image("lost.pgm"));
  EXPECT_EQ(map_files(yaml).at(1), directory.file("lost.pgm"));
  EXPECT_THROW(map_files(directory.file("lost.yaml")), FileError);
  EXPECT_THROW(map_files(directory.write("b.yaml", "no map")), FileError);
}

}  // namespace
}  // namespace gridmerge
