// SPDX-License-Identifier: Apache-2.0
#include "io/made_directories.hpp"

#include <unistd.h>

#include <system_error>

#include "gridmerge/io/file_error.hpp"

namespace gridmerge::internal {

namespace fs = std::filesystem;

MadeDirectories::MadeDirectories(const fs::path& directory) {
  std::error_code error;
  for (fs::path part = directory; !part.empty() && !fs::exists(part, error); part = part.parent_path())
    made_.push_back(part);
  fs::create_directories(directory, error);
  if (error) {
    remove_empty();
    throw FileError(directory, "cannot be created: " + error.message());
  }
}

MadeDirectories::~MadeDirectories() {
  remove_empty();
}

void MadeDirectories::remove_empty() const {
  for (const fs::path& part : made_) ::rmdir(part.c_str());
}

}  // namespace gridmerge::internal
