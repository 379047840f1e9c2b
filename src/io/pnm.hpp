// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "io/image.hpp"

namespace gridmerge::internal {

/// Whether the bytes begin as a PGM (P2 plain, P5 raw) or PPM (P3, P6) does.
bool looks_like_pnm(std::string_view bytes);

/// Whether its values are written as text: P2 or P3.
bool is_plain_pnm(std::string_view bytes);

/// What the header tells. Throws ParseError when it is malformed.
ImageSize pnm_size(std::string_view head);

/// Reads a PGM or PPM, plain or raw, of any maximum from 1 to 65535, with comments. Bytes after the last
/// pixel are ignored (the format allows further images there). Throws ParseError when the header is
/// malformed, the image has more than `max_pixels` pixels, data is missing, or a value exceeds the maximum.
/// O(bytes).
MapImage decode_pnm(std::string_view bytes, std::size_t max_pixels);

/// The bytes of a raw 8-bit PGM of `width` x `height` values, top row first.
std::string encode_pgm(int width, int height, std::span<const std::uint8_t> values);

}  // namespace gridmerge::internal
