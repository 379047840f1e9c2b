// SPDX-License-Identifier: Apache-2.0
#include "io/atomic_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <string>
#include <system_error>
#include <utility>

#include "io/destination.hpp"
#include "io/directory_names.hpp"
#include "io/durable.hpp"

namespace gridmerge::internal {

namespace {

constexpr std::string_view kPrefix = ".gridmerge-", kSuffix = ".tmp";

[[noreturn]] void fail(const std::filesystem::path& path, int error) {
  throw FileError(path, "cannot be written: " + describe_errno(error));
}

// The temporary name does not grow with the final one, so a name of the greatest length still works.
std::string temporary_name(int attempt) {
  return fmt::format("{}{}-{}{}", kPrefix, ::getpid(), attempt, kSuffix);
}

bool is_temporary_name(std::string_view name) {
  if (!name.starts_with(kPrefix) || !name.ends_with(kSuffix)) return false;
  const std::string_view numbers =
      name.substr(kPrefix.size(), name.size() - std::min(name.size(), kPrefix.size() + kSuffix.size()));
  return std::count(numbers.begin(), numbers.end(), '-') == 1 && numbers.size() >= 3 &&
         numbers.find_first_not_of("0123456789-") == std::string_view::npos;
}

// Its program lives for as long as the lock cannot be had. Whoever cannot lock or remove leaves it there.
void remove_if_abandoned(const std::filesystem::path& file) {
  const int descriptor = ::open(file.c_str(), O_RDWR | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
  if (descriptor < 0) return;
  struct stat status {};
  if (::fstat(descriptor, &status) == 0 && S_ISREG(status.st_mode) &&
      ::flock(descriptor, LOCK_EX | LOCK_NB) == 0) {
    ::unlink(file.c_str());
  }
  ::close(descriptor);
}

void remove_abandoned(const std::filesystem::path& directory) {
  std::error_code error;
  for (const std::string& name : names_in(directory, error)) {
    if (is_temporary_name(name)) remove_if_abandoned(directory / name);
  }
}

struct Created {
  std::filesystem::path path;
  int descriptor;
};

// mkstemp is no use: it makes files that only their owner may read, and the umask cannot be asked for without
// changing it.
Created create_beside(const std::filesystem::path& path) {
  for (int attempt = 0;; ++attempt) {
    auto candidate = path.parent_path() / temporary_name(attempt);
    const int descriptor = ::open(candidate.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (descriptor < 0 && (errno != EEXIST || attempt == 10000)) fail(path, errno);
    if (descriptor < 0) continue;
    ::flock(descriptor, LOCK_EX);  // where there are no locks, nothing is taken for abandoned
    // Between the two calls another program may have taken it for abandoned.
    struct stat status {};
    if (::fstat(descriptor, &status) == 0 && status.st_nlink > 0) return {std::move(candidate), descriptor};
    ::close(descriptor);
  }
}

}  // namespace

StagedFile::StagedFile(std::filesystem::path path, std::string_view bytes) : path_(std::move(path)) {
  check_destination(path_);
  // A link such as /dev/stdout can lead to a regular file: a rename must not take the place of the link.
  std::error_code absent;
  if (std::filesystem::exists(path_, absent) && std::filesystem::is_symlink(path_, absent))
    path_ = std::filesystem::canonical(path_);
  remove_abandoned(path_.parent_path());
  Created created = create_beside(path_);
  descriptor_ = created.descriptor;
  if (const int error = write_and_flush(descriptor_, bytes); error != 0) {
    ::unlink(created.path.c_str());
    ::close(descriptor_);
    fail(path_, error);
  }
  temporary_ = std::move(created.path);
}

StagedFile::~StagedFile() {
  if (!temporary_.empty()) ::unlink(temporary_.c_str());
  ::close(descriptor_);
}

void StagedFile::commit() {
  if (std::rename(temporary_.c_str(), path_.c_str()) != 0) fail(path_, errno);
  temporary_.clear();
  if (const int error = flush_path(path_.parent_path()); error != 0) fail(path_, error);
}

void write_file_atomically(const std::filesystem::path& path, std::string_view bytes) {
  StagedFile(path, bytes).commit();
}

}  // namespace gridmerge::internal
