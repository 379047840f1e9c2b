// SPDX-License-Identifier: Apache-2.0
#include "gridmerge/io/atomic_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <system_error>
#include <utility>

namespace gridmerge {

namespace {

std::string describe(int error) {
  return std::generic_category().message(error);
}

struct Created {
  std::filesystem::path path;
  int descriptor;
};

// The temporary name does not grow with the final one, so a name of the greatest length still works. mkstemp
// is no use: it makes files that only their owner may read, and the umask cannot be asked for without
// changing it.
Created create_beside(const std::filesystem::path& path) {
  for (int attempt = 0;; ++attempt) {
    const auto candidate = path.parent_path() / fmt::format(".gridmerge-{}-{}.tmp", ::getpid(), attempt);
    const int descriptor = ::open(candidate.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (descriptor >= 0) return {candidate, descriptor};
    if (errno != EEXIST || attempt == 10000) throw FileError(path, "cannot be written: " + describe(errno));
  }
}

// 0, or the error that stopped it.
int write_and_flush(int descriptor, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(descriptor, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return errno;
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
  // Without it a crash after the rename could leave an empty file under the final name. Some file systems
  // have no such call; their word is all there is then.
  if (::fsync(descriptor) != 0 && errno != EINVAL && errno != ENOTSUP) return errno;
  return 0;
}

}  // namespace

StagedFile::StagedFile(std::filesystem::path path, std::string_view bytes) : path_(std::move(path)) {
  std::error_code ignored;
  const std::filesystem::file_status status = std::filesystem::status(path_, ignored);
  if (!path_.has_filename() || std::filesystem::is_directory(status)) {
    throw FileError(path_, "cannot be written: it names a directory");
  }
  // A rename would put a file in the place of a device such as /dev/null, for everybody.
  if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status)) {
    throw FileError(path_, "cannot be written: it is not a regular file");
  }
  // Nor may it take the place of a link such as /dev/stdout, which can lead to a regular file.
  if (std::filesystem::exists(status) &&
      std::filesystem::is_symlink(std::filesystem::symlink_status(path_, ignored))) {
    path_ = std::filesystem::canonical(path_);
  }
  Created created = create_beside(path_);
  int error = write_and_flush(created.descriptor, bytes);
  if (::close(created.descriptor) != 0 && error == 0) error = errno;
  if (error != 0) {
    ::unlink(created.path.c_str());
    throw FileError(path_, "cannot be written: " + describe(error));
  }
  temporary_ = std::move(created.path);
}

StagedFile::~StagedFile() {
  if (!temporary_.empty()) ::unlink(temporary_.c_str());
}

StagedFile::StagedFile(StagedFile&& other) noexcept
    : path_(std::move(other.path_)), temporary_(std::exchange(other.temporary_, {})) {}

void StagedFile::commit() {
  if (std::rename(temporary_.c_str(), path_.c_str()) != 0) {
    throw FileError(path_, "cannot be written: " + describe(errno));
  }
  temporary_.clear();
}

void write_file_atomically(const std::filesystem::path& path, std::string_view bytes) {
  StagedFile(path, bytes).commit();
}

}  // namespace gridmerge
