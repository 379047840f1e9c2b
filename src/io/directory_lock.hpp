// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>

#include "internal_export.hpp"
#include "io/made_directories.hpp"

namespace gridmerge::internal {

/// A directory that one writer at a time has to itself. The lock is a file, `.gridmerge.lock`, which goes
/// with this object; the system frees it when the program dies, whatever way. On a file system without locks
/// writers do not wait for each other.
class DirectoryLock {
 public:
  enum class IfMissing { fail, make };

  /// Waits for another writer, for a minute at most. Throws FileError, and Cancelled.
  DirectoryLock(const std::filesystem::path& directory, IfMissing if_missing);
  ~DirectoryLock();
  DirectoryLock(const DirectoryLock&) = delete;
  DirectoryLock& operator=(const DirectoryLock&) = delete;

 private:
  std::unique_ptr<MadeDirectories> made_;
  std::filesystem::path file_;
  int descriptor_;
};

}  // namespace gridmerge::internal
