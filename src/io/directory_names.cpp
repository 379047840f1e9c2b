// SPDX-License-Identifier: Apache-2.0
#include "io/directory_names.hpp"

#include <dirent.h>
#include <unistd.h>

#include <cerrno>
#include <memory>
#include <string_view>

namespace gridmerge::internal {

namespace fs = std::filesystem;

namespace {

struct Close {
  void operator()(DIR* stream) const { ::closedir(stream); }
};

std::error_code last_error() {
  return {errno, std::generic_category()};
}

}  // namespace

std::vector<std::string> names_in(const fs::path& directory, std::error_code& error) {
  std::vector<std::string> names;
  error.clear();
  const std::unique_ptr<DIR, Close> stream(::opendir(directory.empty() ? "." : directory.c_str()));
  if (!stream) error = last_error();
  while (!error) {
    errno = 0;
    const dirent* const entry = ::readdir(stream.get());
    if (entry == nullptr) {
      error = last_error();
      break;
    }
    const std::string_view name = entry->d_name;
    if (name != "." && name != "..") names.emplace_back(name);
  }
  return names;
}

void remove_directory(const fs::path& directory) {
  std::error_code error;
  for (const std::string& name : names_in(directory, error)) {
    const fs::path path = directory / name;
    std::error_code unknown;
    if (fs::is_directory(fs::symlink_status(path, unknown))) {
      remove_directory(path);
    } else if (::unlink(path.c_str()) != 0 && errno != ENOENT) {
      throw fs::filesystem_error("cannot be removed", path, last_error());
    }
  }
  if (!error && ::rmdir(directory.c_str()) != 0) error = last_error();
  if (error) throw fs::filesystem_error("cannot be removed", directory, error);
}

}  // namespace gridmerge::internal
