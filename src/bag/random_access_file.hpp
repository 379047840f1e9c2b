// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>

namespace gridmerge::internal {

/// A regular file of which any part can be read. It is read by calls, not mapped: a mapped file that somebody
/// cuts short ends the program.
class RandomAccessFile {
 public:
  /// Throws FileError when `path` is missing, unreadable or no regular file. Messages name it `shown`, where
  /// that is not empty.
  explicit RandomAccessFile(const std::filesystem::path& path, const std::filesystem::path& shown = {});
  ~RandomAccessFile();
  RandomAccessFile(const RandomAccessFile&) = delete;
  RandomAccessFile& operator=(const RandomAccessFile&) = delete;

  /// [bytes], when it was opened.
  std::uint64_t size() const { return size_; }

  /// Reads up to `count` bytes at `offset`; fewer only where the file ends. Throws FileError.
  std::size_t read(std::uint64_t offset, char* to, std::size_t count) const;

  /// The same as a text.
  std::string read(std::uint64_t offset, std::size_t count) const;

  /// What messages name it.
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
  int descriptor_;
  std::uint64_t size_ = 0;
};

}  // namespace gridmerge::internal
