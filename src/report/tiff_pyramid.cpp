// SPDX-License-Identifier: Apache-2.0
#include "report/tiff_pyramid.hpp"

#include <zlib.h>

#include <algorithm>
#include <new>
#include <utility>

#include "grid/parallel.hpp"
#include "gridmerge/grid/execution.hpp"
#include "report/tiff_tags.hpp"

namespace gridmerge::internal {

namespace {

constexpr std::size_t kTilePixels = std::size_t{TiffPyramid::kTile} * TiffPyramid::kTile;

/// A zlib stream, as TIFF's "Adobe deflate" has it.
std::string deflated(const std::vector<std::uint8_t>& pixels) {
  constexpr int kLevel = 6;
  uLongf size = compressBound(pixels.size());
  std::string stream(size, '\0');
  if (compress2(reinterpret_cast<Bytef*>(stream.data()), &size, pixels.data(), pixels.size(), kLevel) != Z_OK)
    throw std::bad_alloc();  // nothing else can be wrong
  stream.resize(size);
  return stream;
}

/// What stands for two pixels: a wall stays, and what is known.
std::uint8_t strongest(std::uint8_t a, std::uint8_t b) {
  if (a == TiffPyramid::kUnknown) return b;
  if (b == TiffPyramid::kUnknown) return a;
  return std::max(a, b);
}

/// White to black for 0 to 100, and a bluish gray for what is unknown: red, green and blue of all 256 values.
std::vector<std::uint16_t> palette() {
  constexpr std::size_t kValues = 256;
  std::vector<std::uint16_t> colours(3 * kValues);
  for (std::size_t channel = 0; channel < 3; ++channel) {
    for (std::size_t value = 0; value <= 100; ++value)
      colours[channel * kValues + value] = static_cast<std::uint16_t>(65535 - 65535 * value / 100);
    for (std::size_t value = 101; value < kValues; ++value)
      colours[channel * kValues + value] = channel == 2 ? 0xD2D2 : 0xCDCD;
  }
  return colours;
}

}  // namespace

struct TiffPyramid::Level {
  Level(const std::filesystem::path& file, int level_width, int level_height)
      : width(level_width), height(level_height), spool(file) {}

  int tiles_across() const { return (width - 1) / kTile + 1; }
  int rows_wanted() const { return std::min(kTile, height - rows_done); }
  int rows_held() const { return static_cast<int>(rows.size() / static_cast<std::size_t>(width)); }

  int width;
  int height;
  int rows_done = 0;               // in tiles that are in the spool
  std::vector<std::uint8_t> rows;  // that wait for a row of tiles to be whole
  SpoolFile spool;
  std::vector<std::uint64_t> sizes;  // of the tiles in the spool
};

TiffPyramid::TiffPyramid(const std::filesystem::path& file, int width, int height) {
  while (true) {
    levels_.push_back(std::make_unique<Level>(file, width, height));
    if (std::max(width, height) <= kTile) return;
    width = (width + 1) / 2;
    height = (height + 1) / 2;
  }
}

TiffPyramid::~TiffPyramid() = default;

int TiffPyramid::width() const {
  return levels_.front()->width;
}

int TiffPyramid::height() const {
  return levels_.front()->height;
}

int TiffPyramid::rows_left() const {
  return levels_.front()->rows_wanted();
}

void TiffPyramid::add_rows(const std::vector<std::uint8_t>& rows) {
  levels_.front()->rows = rows;
  for (std::size_t i = 0; i < levels_.size(); ++i) {
    if (levels_[i]->rows_wanted() == 0 || levels_[i]->rows_held() < levels_[i]->rows_wanted()) return;
    add_tiles(i);
  }
}

/// Of the rows that a level holds, which are a row of tiles. The next level gets half as many.
void TiffPyramid::add_tiles(std::size_t level) {
  Level& from = *levels_[level];
  const int rows = from.rows_held();
  const auto width = static_cast<std::size_t>(from.width);
  std::vector<std::string> tiles(static_cast<std::size_t>(from.tiles_across()));
  parallel_for(tiles.size(), [&](std::size_t i) {
    throw_if_cancelled();
    std::vector<std::uint8_t> tile(kTilePixels, kUnknown);
    const std::size_t left = i * kTile, columns = std::min<std::size_t>(kTile, width - left);
    for (int row = 0; row < rows; ++row)
      std::copy_n(from.rows.begin() + static_cast<std::ptrdiff_t>(row * width + left), columns,
                  tile.begin() + static_cast<std::ptrdiff_t>(row) * kTile);
    tiles[i] = deflated(tile);
  });
  for (const std::string& tile : tiles) {
    from.spool.append(tile);
    from.sizes.push_back(tile.size());
  }
  if (level + 1 < levels_.size()) {
    Level& to = *levels_[level + 1];
    for (int row = 0; row < rows; row += 2) {
      const std::uint8_t* const upper = from.rows.data() + row * width;
      const std::uint8_t* const lower = row + 1 < rows ? upper + width : upper;
      for (std::size_t column = 0; column < width; column += 2) {
        const std::size_t right = std::min(column + 1, width - 1);
        to.rows.push_back(
            strongest(strongest(upper[column], upper[right]), strongest(lower[column], lower[right])));
      }
    }
  }
  from.rows_done += rows;
  from.rows.clear();
}

void TiffPyramid::write(StagedFile& file, const Place& place) const {
  constexpr std::uint16_t kKindOfPicture = 254, kWidth = 256, kHeight = 257, kBits = 258, kCompression = 259,
                          kColours = 262, kDescription = 270, kChannels = 277, kProgram = 305, kPalette = 320,
                          kTileWidth = 322, kTileHeight = 323, kTileOffsets = 324, kTileSizes = 325,
                          kNumbers = 339, kPixelSize = 33550, kTiePoint = 33922, kGeoKeys = 34735,
                          kGeoText = 34737, kNoData = 42113;
  const auto tags_of = [&](const Level& level, std::uint64_t first_tile) {
    const bool is_overview = &level != levels_.front().get();
    TiffTags tags;
    tags.add_longs(kKindOfPicture, {is_overview ? 1U : 0U});
    tags.add_longs(kWidth, {static_cast<std::uint32_t>(level.width)});
    tags.add_longs(kHeight, {static_cast<std::uint32_t>(level.height)});
    tags.add_shorts(kBits, {8});
    tags.add_shorts(kCompression, {8});  // Adobe deflate
    tags.add_shorts(kColours, {3});      // of a palette
    tags.add_shorts(kChannels, {1});
    tags.add_shorts(kPalette, palette());
    tags.add_longs(kTileWidth, {kTile});
    tags.add_longs(kTileHeight, {kTile});
    std::vector<std::uint64_t> offsets;
    for (const std::uint64_t size : level.sizes) {
      offsets.push_back(first_tile);
      first_tile += size;
    }
    tags.add_offsets(kTileOffsets, offsets);
    tags.add_offsets(kTileSizes, level.sizes);
    tags.add_shorts(kNumbers, {1});  // whole numbers from 0 on
    tags.add_text(kNoData, std::to_string(kUnknown));
    if (is_overview) return tags;
    tags.add_text(kDescription, place.description);
    tags.add_text(kProgram, "gridmerge");
    tags.add_doubles(kPixelSize, {place.resolution, place.resolution, 0.0});
    tags.add_doubles(kTiePoint, {0.0, 0.0, 0.0, place.top_left.x, place.top_left.y, 0.0});
    // GeoTIFF 1.1, section 7: a frame of its own, in metres, and a pixel is an area.
    const std::string frame = place.frame + "|";
    constexpr std::uint16_t kModel = 1024, kRaster = 1025, kCitation = 1026, kUnit = 3076, kOwn = 32767,
                            kArea = 1, kMetre = 9001;
    tags.add_shorts(kGeoKeys, {1,         1,        1,
                               4,  //
                               kModel,    0,        1,
                               kOwn,  //
                               kRaster,   0,        1,
                               kArea,  //
                               kCitation, kGeoText, static_cast<std::uint16_t>(frame.size()),
                               0,  //
                               kUnit,     0,        1,
                               kMetre});
    tags.add_text(kGeoText, frame);
    return tags;
  };

  // All directories first, then the smallest overview, and the picture itself last: who looks at it from afar
  // reads the beginning of the file alone.
  std::uint64_t next = TiffTags::header().size();
  for (const auto& level : levels_) next += tags_of(*level, 0).size();
  std::vector<std::uint64_t> first_tiles(levels_.size());
  for (std::size_t i = levels_.size(); i-- > 0;) {
    first_tiles[i] = next;
    next += levels_[i]->spool.size();
  }
  std::string head = TiffTags::header();
  for (std::size_t i = 0; i < levels_.size(); ++i)
    head += tags_of(*levels_[i], first_tiles[i]).bytes(head.size(), i + 1 < levels_.size());
  file.append(head);
  for (std::size_t i = levels_.size(); i-- > 0;) levels_[i]->spool.copy_to(file);
}

}  // namespace gridmerge::internal
