// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "gridmerge/export.hpp"
#include "gridmerge/match/match_result.hpp"

namespace gridmerge {

/// A match in a form that another process reads, on any machine: every bit of it. About 200 bytes a
/// hypothesis.
GRIDMERGE_EXPORT std::string to_bytes(const MatchResult& match);

/// What to_bytes() was given. Throws std::invalid_argument, with a message that begins with a verb, for bytes
/// that are no match. O(bytes).
GRIDMERGE_EXPORT MatchResult match_from_bytes(std::string_view bytes);

}  // namespace gridmerge
