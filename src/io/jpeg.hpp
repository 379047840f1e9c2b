// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>

#include "io/image.hpp"

namespace gridmerge::internal {

/// Whether the bytes begin as a JPEG does.
bool looks_like_jpeg(std::string_view bytes);

/// What the frame's header tells; nothing where it is not in `head`.
std::optional<ImageSize> jpeg_size(std::string_view head);

/// Reads a JPEG, gray or in colours, baseline or progressive. Throws ParseError when the bytes are broken or
/// end early, the image has more than `max_pixels` pixels or more than 8 bits a channel, or is of a kind that
/// lets a small file stand for a large image (arithmetic coding, hundreds of scans). O(pixels).
MapImage decode_jpeg(std::string_view bytes, std::size_t max_pixels);

}  // namespace gridmerge::internal
