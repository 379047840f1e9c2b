// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

#include "internal_export.hpp"

namespace gridmerge::internal {

/// Who names a file. A user may name a pipe; where a file names one, the program would wait for what may
/// never come.
enum class NamedBy { user, file };

/// Reads a file in steps, so that its first bytes can decide how many more are worth having.
class GRIDMERGE_INTERNAL_EXPORT FileReader {
 public:
  /// Throws FileError when `path` is missing, unreadable or a directory, and, named by a file, when it is no
  /// regular file.
  explicit FileReader(std::filesystem::path path, NamedBy named_by = NamedBy::user);
  ~FileReader();
  FileReader(const FileReader&) = delete;
  FileReader& operator=(const FileReader&) = delete;

  /// Reads on until `count` bytes are held or the file ends, and returns all bytes held. Throws FileError.
  const std::string& read_up_to(std::size_t count);

  /// All of the file. Throws FileError when it is longer than `max_bytes`.
  const std::string& read_all(std::size_t max_bytes);

 private:
  std::filesystem::path path_;
  int descriptor_;
  std::size_t size_hint_ = 0;
  std::string bytes_;
};

}  // namespace gridmerge::internal
