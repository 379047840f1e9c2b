// SPDX-License-Identifier: Apache-2.0
#include "io/faulty_disk.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <string>

namespace gridmerge::test {

namespace {

FaultyDisk* current = nullptr;

int fail(int error) {
  errno = error;
  return -1;
}

}  // namespace

FaultyDisk::FaultyDisk() {
  current = this;
}

FaultyDisk::~FaultyDisk() {
  current = nullptr;
}

}  // namespace gridmerge::test

// In the place of the system's, for the whole program.
extern "C" {

int symlink(const char* text, const char* path) noexcept {
  const auto* disk = gridmerge::test::current;
  if (disk != nullptr && disk->link_error != 0) return gridmerge::test::fail(disk->link_error);
  return ::symlinkat(text, AT_FDCWD, path);
}

int linkat(int from, const char* file, int to, const char* name, int flags) noexcept {
  const auto* disk = gridmerge::test::current;
  if (disk != nullptr && disk->hard_link_error != 0) return gridmerge::test::fail(disk->hard_link_error);
  return static_cast<int>(::syscall(SYS_linkat, from, file, to, name, flags));
}

int unlink(const char* path) noexcept {
  const auto* disk = gridmerge::test::current;
  if (disk != nullptr && disk->at_unlink) disk->at_unlink(path);
  return ::unlinkat(AT_FDCWD, path, 0);
}

int fsync(int descriptor) {
  auto* disk = gridmerge::test::current;
  if (disk != nullptr && disk->at_flush)
    disk->at_flush(std::filesystem::read_symlink("/proc/self/fd/" + std::to_string(descriptor)));
  if (disk != nullptr && !disk->flush_errors.empty()) {
    const int error = disk->flush_errors.front();
    disk->flush_errors.pop_front();
    return gridmerge::test::fail(error);
  }
  struct stat status {};
  if (disk != nullptr && ::fstat(descriptor, &status) == 0 && S_ISREG(status.st_mode))
    disk->flushed.push_back(static_cast<std::uintmax_t>(status.st_size));
  return static_cast<int>(::syscall(SYS_fsync, descriptor));
}

}  // extern "C"
