// SPDX-License-Identifier: Apache-2.0
#include "io/image.hpp"

#include <fmt/format.h>

#include <array>
#include <limits>
#include <optional>
#include <stdexcept>

#include "io/bmp.hpp"
#include "io/jpeg.hpp"
#include "io/parse_error.hpp"
#include "io/png_map.hpp"
#include "io/pnm.hpp"

namespace gridmerge::internal {

namespace {

constexpr const char* kImagesRead = "PGM, PPM, PNG, BMP or JPEG";

}  // namespace

std::size_t most_image_bytes(std::string_view head, std::size_t max_pixels) {
  // A plain PPM writes a pixel as three numbers of up to five digits, each with a space. The rest is what
  // cameras and programs say of a picture: thumbnails, depths, texts.
  constexpr std::size_t kOfPlainPnm = 24, kOfOthers = 8, kRest = std::size_t{64} << 20;
  const std::optional<ImageSize> size = looks_like_png(head)    ? png_size(head)
                                        : looks_like_pnm(head)  ? pnm_size(head)
                                        : looks_like_bmp(head)  ? bmp_size(head)
                                        : looks_like_jpeg(head) ? jpeg_size(head)
                                                                : std::nullopt;
  if (!size) return looks_like_jpeg(head) ? kRest : head.size();  // of a JPEG it may come behind all that
  check_image_size(size->width, size->height, max_pixels);
  return size->width * size->height * (is_plain_pnm(head) ? kOfPlainPnm : kOfOthers) + kRest;
}

bool looks_like_image(std::string_view bytes) {
  return looks_like_png(bytes) || looks_like_pnm(bytes) || looks_like_bmp(bytes) || looks_like_jpeg(bytes);
}

void refuse_other_kinds(std::string_view bytes) {
  if (bytes.starts_with("version https://git-lfs.github.com/spec/"))
    throw ParseError("a Git LFS pointer, not the file itself: fetch it with 'git lfs pull'");
  using namespace std::string_view_literals;  // some beginnings hold a NUL
  for (const std::string_view beginning : {"\x89MCAP0\r\n"sv, "SQLite format 3\0"sv, "#ROSBAG V"sv}) {
    if (bytes.starts_with(beginning))
      throw ParseError("a ROS bag, and no map file: a bag can be read where it is a regular file");
  }
  struct Kind {
    std::string_view beginning;
    const char* name;
  };
  constexpr std::array kKinds{
      Kind{"GIF8"sv, "a GIF image"},
      Kind{"II*\0"sv, "a TIFF image"},
      Kind{"MM\0*"sv, "a TIFF image"},
      Kind{"P1"sv, "a PBM image"},
      Kind{"P4"sv, "a PBM image"},
      Kind{"P7"sv, "a PAM image"},
      Kind{"<svg"sv, "an SVG image"},
      Kind{"<?xml"sv, "an XML file"},
      Kind{"<!DOCTYPE"sv, "a web page"},
      Kind{"<!doctype"sv, "a web page"},
      Kind{"<html"sv, "a web page"},
      Kind{"%PDF"sv, "a PDF document"},
      Kind{"\x1f\x8b"sv, "a gzip archive"},
      Kind{"PK\x03\x04"sv, "a ZIP archive"},
      Kind{"RIFF"sv, "a WebP or other RIFF file"},
  };
  for (const Kind& kind : kKinds) {
    if (bytes.starts_with(kind.beginning))
      throw ParseError(fmt::format("{}, which is not read: an image must be {}", kind.name, kImagesRead));
  }
}

MapImage decode_image(std::string_view bytes, std::size_t max_pixels) {
  if (bytes.empty()) throw ParseError("the file is empty");
  if (looks_like_png(bytes)) return decode_png_map(bytes, max_pixels);
  if (looks_like_pnm(bytes)) return decode_pnm(bytes, max_pixels);
  if (looks_like_bmp(bytes)) return decode_bmp(bytes, max_pixels);
  if (looks_like_jpeg(bytes)) return decode_jpeg(bytes, max_pixels);
  refuse_other_kinds(bytes.substr(0, kTellingBytes));
  throw ParseError(fmt::format("no image of a kind that is read: it must be {}", kImagesRead));
}

void check_image_size(std::uint64_t width, std::uint64_t height, std::size_t max_pixels) {
  if (width == 0 || height == 0) throw ParseError("the image has no pixels");
  constexpr std::uint64_t kMaxSide =
      std::numeric_limits<int>::max();  // two such sides still multiply in 64 bits
  if (width > kMaxSide || height > kMaxSide || width * height > max_pixels) {
    throw ParseError(fmt::format("{} x {} pixels exceed the limit of {}", width, height, max_pixels));
  }
}

}  // namespace gridmerge::internal
