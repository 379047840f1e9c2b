// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <system_error>
#include <vector>

#include "internal_export.hpp"

namespace gridmerge::internal {

/// A directory, made if need be with its parents. What was made outlives a power cut: the directory that
/// lists it is flushed. It is removed with this object unless there is something in it by then, so that work
/// that fails leaves no empty directory behind.
class GRIDMERGE_INTERNAL_EXPORT MadeDirectories {
 public:
  /// Throws FileError.
  explicit MadeDirectories(const std::filesystem::path& directory);
  ~MadeDirectories();
  MadeDirectories(const MadeDirectories&) = delete;
  MadeDirectories& operator=(const MadeDirectories&) = delete;

 private:
  std::error_code flush_parents() const;
  void remove_empty() const;

  std::vector<std::filesystem::path> made_;  // the innermost first
};

}  // namespace gridmerge::internal
