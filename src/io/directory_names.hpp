// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <system_error>
#include <vector>

#include "internal_export.hpp"

namespace gridmerge::internal {

// What the iterators of <filesystem> are for: those of libstdc++ end the program when there is no memory for
// a name.

/// The names of what is in a directory. When it cannot be read, `error` says why, and what was read by then
/// is returned. An empty path is the working directory.
GRIDMERGE_INTERNAL_EXPORT std::vector<std::string> names_in(const std::filesystem::path& directory,
                                                            std::error_code& error);

/// Removes a directory with all that is in it; links are not followed. Throws
/// std::filesystem::filesystem_error.
void remove_directory(const std::filesystem::path& directory);

}  // namespace gridmerge::internal
