// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "gridmerge/match/match_result.hpp"

namespace gridmerge::internal {

/// The content of a file that holds a match: a line that names the format, one with the key, the match, and
/// the SHA-256 of all these bytes.
std::string format_match_file(const MatchResult& match, std::string_view key);

/// What format_match_file() was given. Throws std::invalid_argument, with a message that begins with a verb,
/// for anything else.
MatchResult parse_match_file(std::string_view bytes, std::string_view key);

}  // namespace gridmerge::internal
