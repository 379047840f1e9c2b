// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

namespace gridmerge::paper {

inline constexpr int kFirstFigure = 1;
inline constexpr int kLastFigure = 11;  ///< 12 is of real maps: ./dev paper fig 12

/// Writes the pictures of a figure into a folder, and returns what they show, in Markdown. Throws
/// std::invalid_argument for a number that is no figure's.
std::string make_figure(int number, const std::filesystem::path& folder);

}  // namespace gridmerge::paper
