// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace gridmerge::internal {

/// What a reading call gave.
struct BytesRead {
  std::size_t count = 0;
  int error = 0;  ///< the errno that stopped it; 0 if none did
};

/// Reads up to `count` bytes of an open file at `offset`; fewer only where the file ends, or an error stops
/// it.
BytesRead try_read_at(int descriptor, std::uint64_t offset, char* to, std::size_t count);

/// The same in steps. Throws FileError, of the file `shown`, and Cancelled.
std::size_t read_at(int descriptor, std::uint64_t offset, char* to, std::size_t count,
                    const std::filesystem::path& shown);

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

/// Reads small parts of a file, about in the order in which they stand, by few calls of the system.
class BufferedReader {
 public:
  /// The file must outlive it.
  explicit BufferedReader(const RandomAccessFile& file) : file_(file) {}

  /// As RandomAccessFile::read(). The bytes are there until the next call.
  std::string_view read(std::uint64_t offset, std::size_t count);

 private:
  const RandomAccessFile& file_;
  std::uint64_t begin_ = 0;  // of what is held
  std::string held_;
};

}  // namespace gridmerge::internal
