// SPDX-License-Identifier: Apache-2.0
#include "io/made_directories.hpp"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <string>
#include <system_error>

#include "gridmerge/io/file_error.hpp"
#include "io/durable.hpp"

namespace gridmerge::internal {

namespace fs = std::filesystem;

// Another program that looks at the same time may have made a directory, and removes it as it is empty: then
// one is missing that was there, and all is tried again.
constexpr int kTries = 1000;

MadeDirectories::MadeDirectories(const fs::path& directory) {
  std::error_code error;
  for (fs::path part = directory; !part.empty() && !fs::exists(part, error); part = part.parent_path())
    made_.push_back(part);
  for (int i = 0; i < kTries; ++i) {
    fs::create_directories(directory, error);
    if (error != std::errc::no_such_file_or_directory) break;
  }
  if (!error) error = flush_parents();
  if (error) {
    const auto link = std::find_if(made_.begin(), made_.end(), [](const fs::path& part) {
      std::error_code ignored;
      return fs::is_symlink(part, ignored);  // which does not exist only where nothing is behind it
    });
    const std::string cause =
        link == made_.end() ? error.message() : link->string() + " is a link to what is not there";
    remove_empty();
    throw FileError(directory, "cannot be created: " + cause);
  }
}

MadeDirectories::~MadeDirectories() {
  remove_empty();
}

// The outermost first: a directory is of no use before its parent lasts. Another program that has made the
// same ones may have removed them again by now.
std::error_code MadeDirectories::flush_parents() const {
  for (auto part = made_.rbegin(); part != made_.rend(); ++part) {
    const int error = flush_path(part->parent_path());
    if (error != 0 && error != ENOENT) return {error, std::generic_category()};
  }
  return {};
}

void MadeDirectories::remove_empty() const {
  for (const fs::path& part : made_) ::rmdir(part.c_str());
}

}  // namespace gridmerge::internal
