// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>

#include "bag/scratch_file.hpp"

namespace gridmerge::internal {

/// What a file packed with Zstandard unpacks to, in a file without a name. Its bytes are gone when nobody has
/// it open any more. Why a file: bags are large, and SQLite wants one.
class UnpackedFile {
 public:
  /// Larger bags are to be unpacked by their user: whoever sent it might want the disk full.
  static constexpr std::uint64_t kMaxBytes = std::uint64_t{4} << 30;

  /// Unpacks all of `packed`. Throws FileError when it does not unpack, or to more than `max_bytes`.
  explicit UnpackedFile(const std::filesystem::path& packed, std::uint64_t max_bytes = kMaxBytes);

  /// What opens it, as long as the object lives.
  std::filesystem::path path() const { return file_.path(); }

 private:
  ScratchFile file_;
};

}  // namespace gridmerge::internal
