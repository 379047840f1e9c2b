// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "internal_export.hpp"

namespace gridmerge::internal {

/// The finite number that `text` is, all of it, in any locale: "0.05", "-3", "+1e-2", ".5".
GRIDMERGE_INTERNAL_EXPORT std::optional<double> parse_number(std::string_view text);

/// The shortest text that parse_number reads back to the same bits. It always has a point ("5.0", "1.0e-06"),
/// without which YAML 1.1 readers take it for an integer or for text.
std::string format_number(double value);

}  // namespace gridmerge::internal
