// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "gridmerge/cache/match_cache.hpp"
#include "gridmerge/merge/merger.hpp"

namespace gridmerge::internal {

/// The content of a file that holds log-odds of pairs: a line that names the format, one with the name, the
/// numbers, and the SHA-256 of all these bytes.
std::string format_comparisons(const std::vector<float>& log_odds, std::string_view name);

/// What format_comparisons() was given. Throws std::invalid_argument, with a message that begins with a verb,
/// for anything else.
std::vector<float> parse_comparisons(std::string_view bytes, std::string_view name);

/// In the cache, which must outlive it. What is damaged is missing. When a file cannot be written, warns once
/// if `goes_on_when_full`, and else throws FileError.
ComparisonStore comparisons_in(MatchCache& cache, const Shard& shard, bool goes_on_when_full);

}  // namespace gridmerge::internal
