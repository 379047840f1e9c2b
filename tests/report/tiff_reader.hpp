// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>
#include <zlib.h>

#include <bit>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "report/tiff_pyramid.hpp"

namespace gridmerge::test {

/// A reader of BigTIFF of its own, by the format's documentation.
struct TiffPicture {
  std::map<int, std::vector<std::uint64_t>> tags;
  std::map<int, std::string> texts;
  std::vector<std::uint8_t> pixels;  // top row first

  std::uint64_t number(int tag) const { return tags.at(tag).at(0); }
  double real(int tag, std::size_t i) const { return std::bit_cast<double>(tags.at(tag).at(i)); }
  int width() const { return static_cast<int>(number(256)); }
  int height() const { return static_cast<int>(number(257)); }
};

class TiffReader {
 public:
  explicit TiffReader(std::string bytes) : bytes_(std::move(bytes)) {}

  std::vector<TiffPicture> pictures() const {
    EXPECT_EQ(bytes_.substr(0, 2), "II");
    EXPECT_EQ(word(2, 2), 43u);
    EXPECT_EQ(word(4, 2), 8u);
    std::vector<TiffPicture> all;
    for (std::uint64_t at = word(8, 8); at != 0;) {
      TiffPicture picture;
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

  int read_tag(std::uint64_t at, TiffPicture& picture) const {
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

  void draw(TiffPicture& picture) const {
    const int tile = static_cast<int>(picture.number(322)), across = (picture.width() - 1) / tile + 1;
    EXPECT_EQ(picture.number(323), picture.number(322));
    EXPECT_EQ(picture.number(259), 8u);
    const auto &offsets = picture.tags.at(324), &sizes = picture.tags.at(325);
    ASSERT_EQ(offsets.size(), static_cast<std::size_t>(across * ((picture.height() - 1) / tile + 1)));
    const int width = picture.width(), height = picture.height();
    picture.pixels.resize(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
    for (std::size_t i = 0; i < offsets.size(); ++i) {
      std::vector<std::uint8_t> pixels(static_cast<std::size_t>(tile) * static_cast<std::size_t>(tile));
      uLongf size = pixels.size();
      const std::string stream = bytes_.substr(offsets[i], sizes.at(i));
      ASSERT_EQ(
          uncompress(pixels.data(), &size, reinterpret_cast<const Bytef*>(stream.data()), stream.size()),
          Z_OK);
      ASSERT_EQ(size, pixels.size());
      int beyond = 0;
      const int left = static_cast<int>(i) % across * tile, top = static_cast<int>(i) / across * tile;
      for (int y = 0; y < tile; ++y) {
        for (int x = 0; x < tile; ++x) {
          const std::uint8_t pixel = pixels[static_cast<std::size_t>(y * tile + x)];
          if (left + x < width && top + y < height)
            picture.pixels[static_cast<std::size_t>((top + y) * width + left + x)] = pixel;
          else
            beyond += pixel == internal::TiffPyramid::kUnknown ? 0 : 1;
        }
      }
      EXPECT_EQ(beyond, 0) << "known beyond the picture";
    }
  }

  std::string bytes_;
};

}  // namespace gridmerge::test
