// SPDX-License-Identifier: Apache-2.0
// Matches for who keeps them or sends them elsewhere: what each is a match of, and its bytes.
#pragma once

#include <string>
#include <string_view>

#include "gridmerge/export.hpp"
#include "gridmerge/grid/occupancy_grid.hpp"
#include "gridmerge/match/match.hpp"
#include "gridmerge/match/match_result.hpp"

namespace gridmerge {

/// The version of the engine that matches pairs, and a digest of its sources: engines of one id give the same
/// answers, but for last digits where C libraries or processors round functions differently.
GRIDMERGE_EXPORT const char* engine_id();

/// A name for what a grid holds: its size, resolution, origin, cells and probabilities. 64 hexadecimal
/// digits, of SHA-256. O(cells).
GRIDMERGE_EXPORT std::string content_id(const OccupancyGrid& grid);

/// A name for a match of two grids: by what they hold, this engine, and the options that change the answer.
/// 64 hexadecimal digits. Throws std::invalid_argument for a random walk, which has more options than these.
GRIDMERGE_EXPORT std::string match_key(const std::string& fixed_content, const std::string& moving_content,
                                       const MatchOptions& options);

/// A match in a form that another process reads, on any machine: every bit of it. About 200 bytes a
/// hypothesis.
GRIDMERGE_EXPORT std::string to_bytes(const MatchResult& match);

/// What to_bytes() was given. Throws std::invalid_argument, with a message that begins with a verb, for bytes
/// that are no match. O(bytes).
GRIDMERGE_EXPORT MatchResult match_from_bytes(std::string_view bytes);

}  // namespace gridmerge
