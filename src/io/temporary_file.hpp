// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "gridmerge/io/file_error.hpp"

namespace gridmerge::internal {

/// Throws FileError: `path` cannot be written, by this errno.
[[noreturn]] void fail_to_write(const std::filesystem::path& path, int error);

/// A file with a name of its own. Not closed and not removed by itself.
struct TemporaryFile {
  std::filesystem::path path;
  int descriptor = -1;  ///< open for reading and writing; holds a lock by which it is no abandoned one
};

/// Makes one in the directory of `path`. Throws FileError, of `path`.
TemporaryFile create_beside(const std::filesystem::path& path);

/// Removes what killed programs have left in a directory. A lock tells it from the files of a program that
/// still runs.
void remove_abandoned(const std::filesystem::path& directory);

}  // namespace gridmerge::internal
