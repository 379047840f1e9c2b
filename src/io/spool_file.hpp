// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string_view>

#include "internal_export.hpp"
#include "io/atomic_file.hpp"

namespace gridmerge::internal {

/// Bytes that are too many to be held until it is known where they go: on disk, without a name, so that
/// nothing of them is left behind however the program ends.
class GRIDMERGE_INTERNAL_EXPORT SpoolFile {
 public:
  /// On the disk of the file that the bytes are for. Throws FileError, of that file.
  explicit SpoolFile(std::filesystem::path beside);
  ~SpoolFile();
  SpoolFile(const SpoolFile&) = delete;
  SpoolFile& operator=(const SpoolFile&) = delete;

  /// Throws FileError.
  void append(std::string_view bytes);
  std::uint64_t size() const { return size_; }
  /// All of them, in the order in which they came. Throws FileError.
  void copy_to(StagedFile& file) const;

 private:
  std::filesystem::path beside_;
  int descriptor_ = -1;
  std::uint64_t size_ = 0;
};

}  // namespace gridmerge::internal
