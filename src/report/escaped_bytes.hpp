// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "internal_export.hpp"

namespace gridmerge::internal {

// Names of files are any bytes, and JSON is UTF-8.

/// Whether a text is UTF-8. O(length).
GRIDMERGE_INTERNAL_EXPORT bool is_utf8(std::string_view text);

/// Any bytes as UTF-8: `\xe9` stands for a byte that is of no character, `\\` for a backslash. O(length).
std::string escape_bytes(std::string_view text);

/// What escape_bytes() was given; nullopt of what it does not write. O(length).
std::optional<std::string> unescape_bytes(std::string_view text);

}  // namespace gridmerge::internal
