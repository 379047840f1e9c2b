// SPDX-License-Identifier: Apache-2.0
#include "image.hpp"

#include <fmt/format.h>

#include <array>
#include <limits>
#include <stdexcept>

#include "bmp.hpp"
#include "gridmerge/io/png.hpp"
#include "jpeg.hpp"
#include "parse_error.hpp"
#include "pnm.hpp"

namespace gridmerge {

namespace {

constexpr const char* kImagesRead = "PGM, PPM, PNG, BMP or JPEG";

bool looks_like_png(std::string_view bytes) {
  return bytes.starts_with("\x89PNG\r\n\x1a\n");
}

// `Depth` is the number of bytes of a channel, `Colors` the number of colour channels before an alpha
// channel.
template <int Depth, int Colors>
void convert_pixels(const PngImage& png, MapImage& image) {
  const auto sample = [&](std::size_t index) -> std::uint32_t {
    if constexpr (Depth == 1) return png.samples[index];
    return static_cast<std::uint32_t>(png.samples[2 * index] << 8 | png.samples[2 * index + 1]);
  };
  const bool has_alpha = png.channels > Colors;
  for (std::size_t pixel = 0; pixel < image.lightness.size(); ++pixel) {
    const std::size_t first = pixel * static_cast<std::size_t>(png.channels);
    std::uint32_t sum = 0;
    for (int channel = 0; channel < Colors; ++channel) sum += sample(first + channel);
    if constexpr (Depth == 2 && Colors == 3)
      sum = (sum + 1) / 3;  // three of 16 bits do not fit; round the mean
    image.lightness[pixel] = static_cast<std::uint16_t>(sum);
    if (has_alpha) {
      const std::uint32_t alpha = sample(first + Colors);
      image.alpha[pixel] = static_cast<std::uint8_t>(Depth == 1 ? alpha : alpha * 255 / 65535);
    }
  }
}

MapImage convert_png(const PngImage& png) {
  MapImage image;
  image.width = png.width;
  image.height = png.height;
  const std::size_t size = static_cast<std::size_t>(png.width) * static_cast<std::size_t>(png.height);
  image.lightness.resize(size);
  if (png.channels % 2 == 0) image.alpha.resize(size);
  const bool color = png.channels >= 3;
  if (png.bit_depth == 16) {
    image.white = 65535;
    color ? convert_pixels<2, 3>(png, image) : convert_pixels<2, 1>(png, image);
  } else {
    image.white = color ? 3 * 255 : 255;
    color ? convert_pixels<1, 3>(png, image) : convert_pixels<1, 1>(png, image);
  }
  return image;
}

}  // namespace

bool looks_like_image(std::string_view bytes) {
  return looks_like_png(bytes) || looks_like_pnm(bytes) || looks_like_bmp(bytes) || looks_like_jpeg(bytes);
}

void refuse_other_kinds(std::string_view bytes) {
  if (bytes.starts_with("version https://git-lfs.github.com/spec/"))
    throw ParseError("a Git LFS pointer, not the file itself: fetch it with 'git lfs pull'");
  struct Kind {
    std::string_view beginning;
    const char* name;
  };
  using namespace std::string_view_literals;  // some beginnings hold a NUL
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
  if (looks_like_png(bytes)) return convert_png(decode_png(bytes, max_pixels));
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

}  // namespace gridmerge
