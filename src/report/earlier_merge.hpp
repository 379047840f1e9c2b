// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace gridmerge::internal {

/// The names of the files in `directory` that an earlier merge surely wrote beside its transforms.json: the
/// merged maps that this names, with their images, and exports called export_file(), of any merged map, that
/// hold what gridmerge writes into them. None where there is no transforms.json, or it is not a merge's.
std::vector<std::string> earlier_outputs(const std::filesystem::path& directory);

/// Whether a mark is in the beginning of a file, which an export has it in. False where it cannot be read.
bool holds(const std::filesystem::path& file, std::string_view mark);

}  // namespace gridmerge::internal
