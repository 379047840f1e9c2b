// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <zlib.h>

#include <algorithm>
#include <bit>
#include <cstdint>
#include <filesystem>
#include <map>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include "gridmerge/merge/fuse.hpp"
#include "report/interchange.hpp"
#include "report/interchange_support.hpp"
#include "report/tiff_pyramid.hpp"
#include "support/temporary_directory.hpp"

namespace gridmerge {

using namespace internal;
using namespace test;
namespace {

/// A reader of BigTIFF of its own, by the format's documentation.
struct Picture {
  std::map<int, std::vector<std::uint64_t>> tags;
  std::map<int, std::string> texts;
  std::vector<std::uint8_t> pixels;  // top row first

  std::uint64_t number(int tag) const { return tags.at(tag).at(0); }
  double real(int tag, std::size_t i) const { return std::bit_cast<double>(tags.at(tag).at(i)); }
  int width() const { return static_cast<int>(number(256)); }
  int height() const { return static_cast<int>(number(257)); }
};

class Reader {
 public:
  explicit Reader(std::string bytes) : bytes_(std::move(bytes)) {}

  std::vector<Picture> pictures() const {
    EXPECT_EQ(bytes_.substr(0, 2), "II");
    EXPECT_EQ(word(2, 2), 43u);
    EXPECT_EQ(word(4, 2), 8u);
    std::vector<Picture> all;
    for (std::uint64_t at = word(8, 8); at != 0;) {
      Picture picture;
      const std::uint64_t count = word(at, 8);
      int before = 0;
      for (std::uint64_t i = 0; i < count; ++i) {
        const int tag = read_tag(at + 8 + 20 * i, picture);
        EXPECT_GT(tag, before) << "tags ascend";
        before = tag;
      }
      draw(picture);
      all.push_back(std::move(picture));
      at = word(at + 8 + 20 * count, 8);
    }
    return all;
  }

 private:
  std::uint64_t word(std::uint64_t at, int size) const {
    std::uint64_t value = 0;
    for (int i = size; i-- > 0;)
      value = value << 8 | static_cast<unsigned char>(bytes_.at(at + static_cast<std::uint64_t>(i)));
    return value;
  }

  int read_tag(std::uint64_t at, Picture& picture) const {
    static const std::map<std::uint64_t, int> sizes{{2, 1}, {3, 2}, {4, 4}, {12, 8}, {16, 8}};
    const int tag = static_cast<int>(word(at, 2)), size = sizes.at(word(at + 2, 2));
    const std::uint64_t count = word(at + 4, 8);
    const std::uint64_t from = count * static_cast<std::uint64_t>(size) <= 8 ? at + 12 : word(at + 12, 8);
    EXPECT_EQ(from % 2, 0u);
    for (std::uint64_t i = 0; i < count; ++i)
      picture.tags[tag].push_back(word(from + i * static_cast<std::uint64_t>(size), size));
    if (size == 1) {
      picture.texts[tag] = bytes_.substr(from, count - 1);
      EXPECT_EQ(bytes_.at(from + count - 1), '\0');
    }
    return tag;
  }

  void draw(Picture& picture) const {
    const int tile = static_cast<int>(picture.number(322)), across = (picture.width() - 1) / tile + 1;
    EXPECT_EQ(picture.number(323), picture.number(322));
    EXPECT_EQ(picture.number(259), 8u);
    const auto &offsets = picture.tags.at(324), &sizes = picture.tags.at(325);
    ASSERT_EQ(offsets.size(), static_cast<std::size_t>(across * ((picture.height() - 1) / tile + 1)));
    picture.pixels.resize(static_cast<std::size_t>(picture.width()) *
                          static_cast<std::size_t>(picture.height()));
    for (std::size_t i = 0; i < offsets.size(); ++i) {
      std::vector<std::uint8_t> pixels(static_cast<std::size_t>(tile) * static_cast<std::size_t>(tile));
      uLongf size = pixels.size();
      const std::string stream = bytes_.substr(offsets[i], sizes.at(i));
      ASSERT_EQ(
          uncompress(pixels.data(), &size, reinterpret_cast<const Bytef*>(stream.data()), stream.size()),
          Z_OK);
      ASSERT_EQ(size, pixels.size());
      const int left = static_cast<int>(i) % across * tile, top = static_cast<int>(i) / across * tile;
      for (int y = 0; y < tile; ++y) {
        for (int x = 0; x < tile; ++x) {
          const std::uint8_t pixel = pixels[static_cast<std::size_t>(y * tile + x)];
          if (left + x < picture.width() && top + y < picture.height())
            picture.pixels[static_cast<std::size_t>((top + y) * picture.width() + left + x)] = pixel;
          else
            EXPECT_EQ(pixel, TiffPyramid::kUnknown) << "beyond the picture";
        }
      }
    }
  }

  std::string bytes_;
};

/// The pictures of what is drawn from these pixels, top row first.
std::vector<Picture> drawn(int width, int height, const std::vector<std::uint8_t>& pixels) {
  const TemporaryDirectory directory;
  const std::string file = directory.file("x.tif");
  TiffPyramid pyramid(file, width, height);
  auto from = pixels.begin();
  while (pyramid.rows_left() > 0) {
    const auto to = from + static_cast<std::ptrdiff_t>(pyramid.rows_left()) * width;
    pyramid.add_rows({from, to});
    from = to;
  }
  StagedFile staged(file);
  pyramid.write(staged, {{1.5, 20.25}, 0.05, "frame of a", "words"});
  staged.commit();
  EXPECT_EQ(directory.names(), std::vector<std::string>{"x.tif"});
  return Reader(read_file(file)).pictures();
}

/// The strongest of two by two, by hand.
std::vector<std::uint8_t> halved(int width, int height, const std::vector<std::uint8_t>& pixels) {
  std::vector<std::uint8_t> half;
  for (int y = 0; y < height; y += 2) {
    for (int x = 0; x < width; x += 2) {
      int most = -1;
      for (int dy = 0; dy < 2; ++dy) {
        for (int dx = 0; dx < 2; ++dx) {
          if (x + dx >= width || y + dy >= height) continue;
          const int pixel = pixels[static_cast<std::size_t>((y + dy) * width + x + dx)];
          if (pixel != TiffPyramid::kUnknown) most = std::max(most, pixel);
        }
      }
      half.push_back(static_cast<std::uint8_t>(most < 0 ? TiffPyramid::kUnknown : most));
    }
  }
  return half;
}

TEST(TiffPyramid, HoldsThePictureAndItsOverviews) {
  std::mt19937 random(1);
  const std::vector<std::pair<int, int>> sizes{{1, 1},      {3, 700},    {512, 512}, {513, 1},
                                               {1025, 513}, {700, 1537}, {1, 2049},  {1300, 1100}};
  for (const auto& [width, height] : sizes) {
    SCOPED_TRACE(std::to_string(width) + " x " + std::to_string(height));
    std::vector<std::uint8_t> pixels(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
    for (std::uint8_t& pixel : pixels)
      pixel = random() % 3 == 0 ? TiffPyramid::kUnknown : static_cast<std::uint8_t>(random() % 101);
    const std::vector<Picture> pictures = drawn(width, height, pixels);
    int level_width = width, level_height = height;
    for (std::size_t i = 0; i < pictures.size(); ++i) {
      const Picture& picture = pictures[i];
      ASSERT_EQ(picture.width(), level_width);
      ASSERT_EQ(picture.height(), level_height);
      ASSERT_TRUE(picture.pixels == pixels) << i;
      EXPECT_EQ(picture.number(254), i == 0 ? 0u : 1u);
      EXPECT_EQ(picture.texts.at(42113), "255");
      // A reader from afar finds overviews first: the smaller, the nearer to the beginning.
      if (i > 0) {
        EXPECT_LT(picture.number(324), pictures[i - 1].number(324));
      }
      pixels = halved(level_width, level_height, pixels);
      level_width = (level_width + 1) / 2;
      level_height = (level_height + 1) / 2;
    }
    EXPECT_LE(std::max(pictures.back().width(), pictures.back().height()), TiffPyramid::kTile);
    if (pictures.size() > 1) {
      EXPECT_GT(std::max(pictures[pictures.size() - 2].width(), pictures[pictures.size() - 2].height()),
                TiffPyramid::kTile);
    }
  }
}

TEST(TiffPyramid, SaysWhereItLies) {
  const Picture picture = drawn(2, 1, {0, 100}).at(0);
  EXPECT_EQ(picture.real(33550, 0), 0.05);
  EXPECT_EQ(picture.real(33550, 1), 0.05);
  EXPECT_EQ(picture.real(33922, 3), 1.5);
  EXPECT_EQ(picture.real(33922, 4), 20.25);
  EXPECT_EQ(picture.texts.at(34737), "frame of a|");
  EXPECT_EQ(picture.texts.at(270), "words");
  // White is free and black is a wall.
  const auto& palette = picture.tags.at(320);
  ASSERT_EQ(palette.size(), 768u);
  EXPECT_EQ(palette[0], 65535u);
  EXPECT_EQ(palette[256 + 100], 0u);
}

// What readers go by, number by number, as the formats' documentation has it.
TEST(TiffPyramid, SaysHowItIsToBeRead) {
  using Values = std::vector<std::uint64_t>;
  std::vector<std::uint8_t> pixels(std::size_t{600} * 2, 7);
  const std::vector<Picture> pictures = drawn(600, 2, pixels);
  ASSERT_EQ(pictures.size(), 2u);
  for (const Picture& picture : pictures) {
    EXPECT_EQ(picture.tags.at(258), Values{8});    // bits
    EXPECT_EQ(picture.tags.at(259), Values{8});    // Adobe deflate
    EXPECT_EQ(picture.tags.at(262), Values{3});    // of a palette
    EXPECT_EQ(picture.tags.at(277), Values{1});    // channels
    EXPECT_EQ(picture.tags.at(322), Values{512});  // a tile's width
    EXPECT_EQ(picture.tags.at(339), Values{1});    // whole numbers from 0 on
    const Values& palette = picture.tags.at(320);
    ASSERT_EQ(palette.size(), 768u);
    for (std::size_t channel = 0; channel < 3; ++channel) {
      for (std::size_t value = 0; value < 256; ++value) {
        const std::uint64_t gray = 65535 - 65535 * value / 100;
        EXPECT_EQ(palette[256 * channel + value], value <= 100 ? gray : channel == 2 ? 0xD2D2u : 0xCDCDu);
      }
    }
  }
  EXPECT_EQ(pictures[0].texts.at(305), "gridmerge");
  for (const std::size_t i : {0u, 1u, 2u, 5u}) EXPECT_EQ(pictures[0].real(33922, i), 0.0);
  EXPECT_EQ(pictures[0].real(33550, 2), 0.0);
  // GeoTIFF 1.1: version 1.1.1 with four keys: a model of its own, a pixel is an area, a citation of 11
  // characters, and metres.
  EXPECT_EQ(pictures[0].tags.at(34735),
            (Values{1, 1, 1, 4, 1024, 0, 1, 32767, 1025, 0, 1, 1, 1026, 34737, 11, 0, 3076, 0, 1, 9001}));
  EXPECT_EQ(pictures[1].tags.count(34735), 0u);
}

/// Value by value what fuse() gives.
void expect_fused(const Picture& picture, const OccupancyGrid& fused) {
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
    const std::vector<Picture> pictures = Reader(read_file(files[i])).pictures();
    expect_fused(pictures.at(0), fuse(placed, finest).grid);
    EXPECT_TRUE(contains(pictures[0].texts.at(34737), i == 0 ? "a_b__.yaml" : "frame of"));
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
  result.components.push_back({{{0, {}}, {1, {60.0, 150.0, 0.0}}}, {}});
  const std::vector<std::string> names{"a", "b"};
  write_export(ExportFormat::geotiff, directory.file("m.tif"), {}, {names, maps, result});
  const std::vector<Picture> pictures = Reader(read_file(directory.file("m.tif"))).pictures();
  ASSERT_EQ(pictures.at(0).width(), 1260);
  ASSERT_EQ(pictures.at(0).height(), 3040);
  const auto at = [&](int column, int row) {
    return pictures[0].pixels[static_cast<std::size_t>(3039 - row) * 1260 + static_cast<std::size_t>(column)];
  };
  EXPECT_EQ(at(5, 7), 85);
  EXPECT_EQ(at(6, 7), 35);
  EXPECT_EQ(at(1206, 3007), 85);
  EXPECT_EQ(at(600, 1500), TiffPyramid::kUnknown);
  ASSERT_EQ(pictures.size(), 4u);
  EXPECT_EQ(*std::max_element(pictures[3].pixels.begin(), pictures[3].pixels.end(),
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
