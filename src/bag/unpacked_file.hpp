// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>

namespace gridmerge::internal {

/// What a file packed with Zstandard unpacks to, as a temporary file. Its name is gone with the object, its
/// bytes when nobody has it open any more. Why a file: bags are large, and SQLite wants one with a name.
class UnpackedFile {
 public:
  /// Larger bags are to be unpacked by their user: whoever sent it might want the disk full.
  static constexpr std::uint64_t kMaxBytes = std::uint64_t{4} << 30;

  /// Unpacks all of `packed`. Throws FileError when it does not unpack, or to more than `max_bytes`.
  explicit UnpackedFile(const std::filesystem::path& packed, std::uint64_t max_bytes = kMaxBytes);
  ~UnpackedFile();
  UnpackedFile(const UnpackedFile&) = delete;
  UnpackedFile& operator=(const UnpackedFile&) = delete;

  /// Where it is as long as the object lives.
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace gridmerge::internal
