// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string_view>
#include <vector>

#include "gridmerge/evaluate/evaluate.hpp"

namespace gridmerge::internal {

/// The readers of evaluate.hpp, given the text of the file at `path`. They throw FileError.
std::vector<TruePair> parse_pairs(const std::filesystem::path& path, std::string_view text);
std::vector<NegativePair> parse_negatives(const std::filesystem::path& path, std::string_view text);
std::vector<TrueSet> parse_sets(const std::filesystem::path& path, std::string_view text);

}  // namespace gridmerge::internal
