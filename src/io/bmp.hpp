// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string_view>

#include "io/image.hpp"

namespace gridmerge::internal {

/// Whether the bytes begin as a Windows bitmap does. 18 bytes suffice.
bool looks_like_bmp(std::string_view bytes);

/// What the header tells. Throws ParseError when it is malformed.
ImageSize bmp_size(std::string_view head);

/// Reads a Windows bitmap of 1, 4 or 8 bits with a palette, or of 24 or 32 bits, not compressed, bottom or
/// top row first. The fourth byte of 32 bits is alpha if the header says so and any pixel uses it. Throws
/// ParseError when the header is malformed or of another kind, the image has more than `max_pixels` pixels,
/// data is missing, or a pixel has no entry in the palette. O(bytes).
MapImage decode_bmp(std::string_view bytes, std::size_t max_pixels);

}  // namespace gridmerge::internal
