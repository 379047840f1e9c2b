// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace gridmerge::internal {

/// Reads values of a message in the Common Data Representation (OMG DDS-XTypes 1.3, 7.4; what ROS 2 puts into
/// bags), one after another: plain CDR of version 1 or 2, of either byte order. Each throws ParseError where
/// the message ends before the value does. The bytes must outlive it.
class CdrReader {
 public:
  /// Reads the four bytes that say how the rest is written.
  explicit CdrReader(std::string_view message);

  std::int32_t read_int32();
  std::uint32_t read_uint32();
  float read_float();
  double read_double();
  std::string read_string();

  /// The bytes of a sequence of values of one byte.
  std::string_view read_bytes();

 private:
  std::string_view take(std::size_t count, std::size_t alignment);
  template <typename Unsigned>
  Unsigned read_unsigned(std::size_t alignment);

  std::string_view body_;
  std::size_t next_ = 0;
  std::size_t max_alignment_ = 8;
  bool is_little_endian_ = true;
};

}  // namespace gridmerge::internal
