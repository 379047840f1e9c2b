// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace gridmerge::internal {

/// The directory of one picture of a BigTIFF file: what is said of it, tag by tag (TIFF 6.0, section 2; sizes
/// and places in the file are of 64 bits).
class TiffTags {
 public:
  /// The header of a file whose first directory follows it.
  static std::string header();

  /// Tags may come in any order, each once.
  void add_shorts(std::uint16_t tag, const std::vector<std::uint16_t>& values);
  void add_longs(std::uint16_t tag, const std::vector<std::uint32_t>& values);
  void add_offsets(std::uint16_t tag, const std::vector<std::uint64_t>& values);
  void add_doubles(std::uint16_t tag, const std::vector<double>& values);
  void add_text(std::uint16_t tag, std::string_view text);

  /// Of bytes(). O(tags).
  std::uint64_t size() const;

  /// The directory and all values that it leads to, to stand at `offset` of the file, where another directory
  /// follows if `has_next`. O(size()).
  std::string bytes(std::uint64_t offset, bool has_next) const;

 private:
  enum class Type : std::uint16_t;
  struct Tag {
    std::uint16_t tag;
    Type type;
    std::uint64_t count;
    std::string values;  // little-endian
  };
  void add(std::uint16_t tag, Type type, std::uint64_t count, std::string values);

  std::vector<Tag> tags_;  // ascending
};

}  // namespace gridmerge::internal
