// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace gridmerge::internal {

/// The file that makes a folder a rosbag2 bag.
inline constexpr const char* kMetadataName = "metadata.yaml";

/// The names of a bag's files, in their order, from the text of its metadata.yaml. They are names in its
/// folder, whatever folders they stand with. One that is named again counts once. Throws ParseError for a
/// text that names none, or more than 1000.
std::vector<std::string> parse_metadata(std::string_view text);

}  // namespace gridmerge::internal
