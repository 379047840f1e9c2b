// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>

#include "io/image.hpp"

namespace gridmerge::internal {

/// Whether the bytes begin as a PNG does.
bool looks_like_png(std::string_view bytes);

/// What the first 24 bytes of a PNG tell.
std::optional<ImageSize> png_size(std::string_view head);

/// What a map needs of a PNG. Throws ParseError as decode_png() does. O(pixels); memory is that of the result
/// and a few rows.
MapImage decode_png_map(std::string_view bytes, std::size_t max_pixels);

}  // namespace gridmerge::internal
