// SPDX-License-Identifier: Apache-2.0
#include "io/destination.hpp"

#include <system_error>

#include "gridmerge/io/file_error.hpp"

namespace gridmerge::internal {

void check_destination(const std::filesystem::path& path) {
  std::error_code ignored;
  const std::filesystem::file_status status = std::filesystem::status(path, ignored);
  if (!path.lexically_normal().has_filename() || std::filesystem::is_directory(status))
    throw FileError(path, "cannot be written: it names a directory");
  if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status))
    throw FileError(path, "cannot be written: it is not a regular file");
}

}  // namespace gridmerge::internal
