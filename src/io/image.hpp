// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

namespace gridmerge::internal {

/// What a map needs of a picture, top row first. A pixel's lightness is `lightness / white`, exactly:
/// integers, so that every value can be looked up and thresholds are never missed by a rounding.
struct MapImage {
  int width = 0;
  int height = 0;
  std::uint16_t white = 255;             ///< 1..65535
  std::vector<std::uint16_t> lightness;  ///< width * height values up to `white`
  std::vector<std::uint8_t>
      alpha;              ///< as many, 255 only where fully opaque; empty if the picture has no alpha
  bool is_lossy = false;  ///< pixels may be a little lighter or darker than they were drawn
};

/// So many first bytes of a file tell what it is.
inline constexpr std::size_t kTellingBytes = 64;

/// The header of an image lies within so many first bytes; that of a JPEG may come later.
inline constexpr std::size_t kHeaderBytes = std::size_t{1} << 20;

struct ImageSize {
  std::uint64_t width = 0;
  std::uint64_t height = 0;
};

/// So many bytes of a file are worth reading that begins with `head` (kHeaderBytes of it, or all): 8 a pixel,
/// which are RGBA of 16 bits, uncompressed, and some more for the rest. Those of `head` where it is of no
/// image that tells its size. Throws ParseError for an image of more than `max_pixels`.
std::size_t most_image_bytes(std::string_view head, std::size_t max_pixels);

/// Whether the bytes begin as an image of a kind that decode_image() reads.
bool looks_like_image(std::string_view bytes);

/// Throws ParseError, saying what to do, for the beginning of a file that is known to be something else than
/// a YAML or an image that can be read: another kind of image, an archive, a Git LFS pointer.
void refuse_other_kinds(std::string_view bytes);

/// Reads a PGM, PPM, PNG, BMP or JPEG. Throws ParseError. O(pixels).
MapImage decode_image(std::string_view bytes, std::size_t max_pixels);

/// Throws ParseError unless width and height are positive and width * height <= max_pixels.
void check_image_size(std::uint64_t width, std::uint64_t height, std::size_t max_pixels);

}  // namespace gridmerge::internal
