// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string_view>

#include "gridmerge/io/file_error.hpp"
#include "internal_export.hpp"

namespace gridmerge::internal {

/// A file in two steps: bytes go to a temporary file in the same directory, and are flushed to the disk;
/// commit() renames it into place and flushes the directory. Without commit the
/// temporary file disappears with this object. What a killed program has left is removed by the next file
/// that is staged in the same directory; a lock tells it from the file of a program that still runs.
///
/// An existing file is replaced as a whole (of a symbolic link, the file that it leads to); readers see the
/// old bytes or the new ones. A link that leads to nothing is itself replaced by the file. Anything else that
/// exists, a device or a pipe for example, is an error. Permissions are those of any new file: 0666 less the
/// umask. A process over its file size limit gets a FileError only if it ignores SIGXFSZ.
class GRIDMERGE_INTERNAL_EXPORT StagedFile {
 public:
  /// Without bytes yet. Throws FileError; then nothing is left behind.
  explicit StagedFile(std::filesystem::path path);
  /// With these, flushed. Throws FileError; then nothing is left behind.
  StagedFile(std::filesystem::path path, std::string_view bytes);
  ~StagedFile();
  StagedFile(const StagedFile&) = delete;
  StagedFile& operator=(const StagedFile&) = delete;

  /// The file that is replaced: where a link leads to, if the path is one.
  const std::filesystem::path& path() const { return path_; }

  /// Writes more bytes. Throws FileError.
  void append(std::string_view bytes);

  /// Once only. Throws FileError: the destination is as it was, or, if the directory alone cannot be flushed,
  /// it is the new file.
  void commit();

  /// In the place of commit(): gives its bytes, flushed, to this name on the same disk, at which nothing is.
  /// Throws FileError.
  void hand_over(const std::filesystem::path& name);

 private:
  void flush();

  std::filesystem::path path_;
  std::filesystem::path temporary_;  // empty once it is gone
  int descriptor_ = -1;              // open, as it holds the lock
  bool is_flushed_ = false;
};

/// One file, staged and committed. Throws FileError.
GRIDMERGE_INTERNAL_EXPORT void write_file_atomically(const std::filesystem::path& path,
                                                     std::string_view bytes);

}  // namespace gridmerge::internal
