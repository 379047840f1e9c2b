// SPDX-License-Identifier: Apache-2.0
// Values as bytes and back, every bit of them: little-endian whatever the machine.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <string_view>

#include "gridmerge/grid/se2.hpp"

namespace gridmerge::internal {

class ByteWriter {
 public:
  void whole(std::uint64_t value) {
    for (int shift = 0; shift < 64; shift += 8) bytes_ += static_cast<char>(value >> shift & 0xff);
  }
  void byte(std::uint8_t value) { bytes_ += static_cast<char>(value); }
  void number(double value) { whole(std::bit_cast<std::uint64_t>(value)); }
  void pose(const SE2& T) {
    number(T.x);
    number(T.y);
    number(T.theta);
  }
  void text(std::string_view value) {
    whole(value.size());
    bytes_ += value;
  }

  std::string take() { return std::move(bytes_); }

 private:
  std::string bytes_;
};

/// Reads what a ByteWriter has written. Throws std::invalid_argument where the bytes end too early.
class ByteReader {
 public:
  explicit ByteReader(std::string_view bytes) : rest_(bytes) {}

  std::uint64_t whole() {
    const std::string_view eight = take(8);
    std::uint64_t value = 0;
    for (std::size_t i = 8; i-- > 0;) value = value << 8 | static_cast<std::uint8_t>(eight[i]);
    return value;
  }
  std::uint8_t byte() { return static_cast<std::uint8_t>(take(1).front()); }
  double number() { return std::bit_cast<double>(whole()); }
  SE2 pose() {
    SE2 T;
    T.x = number();
    T.y = number();
    T.theta = number();
    return T;
  }
  std::string_view text() { return take(whole()); }

  /// A number of things of which each takes so many bytes at least: no more than the rest can hold.
  std::size_t count(std::size_t least_bytes) {
    const std::uint64_t count = whole();
    if (count > rest_.size() / least_bytes) throw std::invalid_argument("is cut short");
    return static_cast<std::size_t>(count);
  }

  bool is_at_end() const { return rest_.empty(); }

 private:
  std::string_view take(std::uint64_t size) {
    if (size > rest_.size()) throw std::invalid_argument("is cut short");
    const std::string_view taken = rest_.substr(0, static_cast<std::size_t>(size));
    rest_.remove_prefix(static_cast<std::size_t>(size));
    return taken;
  }

  std::string_view rest_;
};

}  // namespace gridmerge::internal
