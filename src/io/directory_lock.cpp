// SPDX-License-Identifier: Apache-2.0
#include "io/directory_lock.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <thread>

#include "gridmerge/grid/execution.hpp"
#include "gridmerge/io/file_error.hpp"
#include "io/durable.hpp"

namespace gridmerge::internal {

namespace {

constexpr auto kPatience = std::chrono::minutes(1);  // no set of files takes as long to write
constexpr auto kPause = std::chrono::milliseconds(5);
// Of making the file: no other program removes the directory as often just before.
constexpr int kTries = 100;

/// False when another has it. Looks again and again, as a wait in the system cannot be cancelled everywhere.
bool try_lock(int descriptor) {
  if (::flock(descriptor, LOCK_EX | LOCK_NB) == 0) return true;
  return errno != EWOULDBLOCK && errno != EINTR;  // there are no locks here
}

/// Whoever had the lock before has removed the file: the next has made another.
bool is_gone(int descriptor) {
  struct stat status {};
  return ::fstat(descriptor, &status) == 0 && status.st_nlink == 0;
}

}  // namespace

DirectoryLock::DirectoryLock(const std::filesystem::path& directory, IfMissing if_missing)
    : file_(directory / ".gridmerge.lock") {
  const auto deadline = std::chrono::steady_clock::now() + kPatience;
  int missing = 0;
  while (true) {
    // Again for each attempt: another program may have made the directory, and removed it as it was empty.
    made_.reset();  // before the next: what both have made, the first would remove again
    if (if_missing == IfMissing::make) made_ = std::make_unique<MadeDirectories>(directory);
    descriptor_ = ::open(file_.c_str(), O_RDWR | O_CREAT | O_NOFOLLOW | O_CLOEXEC, 0666);
    if (descriptor_ < 0 && errno == EACCES) {
      // Another user's, whom one waits for all the same; or there is none, and none can be made.
      descriptor_ = ::open(file_.c_str(), O_RDONLY | O_NOFOLLOW | O_CLOEXEC);
      if (descriptor_ < 0) errno = EACCES;
    }
    if (descriptor_ < 0 && (errno != ENOENT || if_missing == IfMissing::fail || ++missing == kTries))
      throw FileError(directory, "cannot be written to: " + describe_errno(errno));
    if (descriptor_ >= 0 && try_lock(descriptor_) && !is_gone(descriptor_)) return;
    if (descriptor_ >= 0) ::close(descriptor_);
    throw_if_cancelled();
    if (std::chrono::steady_clock::now() > deadline)
      throw FileError(directory, "cannot be written to: another program has been writing to it for a minute");
    std::this_thread::sleep_for(kPause);
  }
}

DirectoryLock::~DirectoryLock() {
  ::unlink(file_.c_str());
  ::close(descriptor_);
}

}  // namespace gridmerge::internal
