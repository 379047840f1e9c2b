// SPDX-License-Identifier: Apache-2.0
#include "io/temporary_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>

#include "io/directory_names.hpp"
#include "io/durable.hpp"

namespace gridmerge::internal {

namespace {

constexpr std::string_view kPrefix = ".gridmerge-", kSuffix = ".tmp";

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

bool leads_to(const std::filesystem::path& file, const struct stat& opened) {
  struct stat named {};
  return ::lstat(file.c_str(), &named) == 0 && named.st_dev == opened.st_dev && named.st_ino == opened.st_ino;
}

// Its program lives for as long as the lock cannot be had. Whoever cannot lock or remove leaves it there.
// Until the lock is there the file may get its final name, and a new one this name: that one is not removed.
void remove_if_abandoned(const std::filesystem::path& file) {
  const int descriptor = ::open(file.c_str(), O_RDWR | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
  if (descriptor < 0) return;
  struct stat status {};
  if (::fstat(descriptor, &status) == 0 && S_ISREG(status.st_mode) &&
      ::flock(descriptor, LOCK_EX | LOCK_NB) == 0 && leads_to(file, status)) {
    ::unlink(file.c_str());
  }
  ::close(descriptor);
}

}  // namespace

void fail_to_write(const std::filesystem::path& path, int error) {
  throw FileError(path, "cannot be written: " + describe_errno(error));
}

void remove_abandoned(const std::filesystem::path& directory) {
  std::error_code error;
  for (const std::string& name : names_in(directory, error)) {
    if (is_temporary_name(name)) remove_if_abandoned(directory / name);
  }
}

// mkstemp is no use: it makes files that only their owner may read, and the umask cannot be asked for without
// changing it.
TemporaryFile create_beside(const std::filesystem::path& path) {
  for (int attempt = 0;; ++attempt) {
    auto candidate = path.parent_path() / temporary_name(attempt);
    const int descriptor = ::open(candidate.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (descriptor < 0 && (errno != EEXIST || attempt == 10000)) fail_to_write(path, errno);
    if (descriptor < 0) continue;
    ::flock(descriptor, LOCK_EX);  // where there are no locks, nothing is taken for abandoned
    // Between the two calls another program may have taken it for abandoned.
    struct stat status {};
    if (::fstat(descriptor, &status) == 0 && status.st_nlink > 0) return {std::move(candidate), descriptor};
    ::close(descriptor);
  }
}

}  // namespace gridmerge::internal
