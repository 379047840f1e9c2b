// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace gridmerge::internal {

/// What a bag unpacks to, on disk in the folder of temporary files. It has no name, so nothing of it stays,
/// however the program ends.
class ScratchFile {
 public:
  /// For a bag that messages name `shown`. Throws FileError when no file can be made.
  explicit ScratchFile(std::filesystem::path shown);
  ~ScratchFile();
  ScratchFile(const ScratchFile&) = delete;
  ScratchFile& operator=(const ScratchFile&) = delete;

  /// Throws FileError, of a full disk for example.
  void append(std::string_view bytes);
  std::uint64_t size() const { return size_; }

  /// The `count` bytes at `offset`, which were appended. Throws FileError.
  std::string read(std::uint64_t offset, std::size_t count) const;

  /// What opens it again, as long as this object lives.
  std::filesystem::path path() const;

 private:
  std::filesystem::path shown_;
  int descriptor_;
  std::uint64_t size_ = 0;
};

}  // namespace gridmerge::internal
