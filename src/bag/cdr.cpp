// SPDX-License-Identifier: Apache-2.0
#include "bag/cdr.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>

#include "io/parse_error.hpp"

namespace gridmerge::internal {

CdrReader::CdrReader(std::string_view message) {
  constexpr std::size_t kHeaderBytes = 4;
  if (message.size() < kHeaderBytes) throw ParseError("the message ends early");
  const unsigned kind = static_cast<std::uint8_t>(message[0]) * 256U + static_cast<std::uint8_t>(message[1]);
  switch (kind) {
    case 0:  // CDR_BE
    case 1:  // CDR_LE
      break;
    case 6:  // CDR2_BE
    case 7:  // CDR2_LE
      max_alignment_ = 4;
      break;
    default:
      throw ParseError(fmt::format("the message is not in plain CDR (its kind is {})", kind));
  }
  is_little_endian_ = kind % 2 == 1;
  body_ = message.substr(kHeaderBytes);
}

std::string_view CdrReader::take(std::size_t count, std::size_t alignment) {
  const std::size_t side = std::min(alignment, max_alignment_);
  const std::size_t begin = (next_ + side - 1) / side * side;
  if (begin > body_.size() || count > body_.size() - begin) throw ParseError("the message ends early");
  next_ = begin + count;
  return body_.substr(begin, count);
}

template <typename Unsigned>
Unsigned CdrReader::read_unsigned(std::size_t alignment) {
  Unsigned value = 0;
  const std::string_view bytes = take(sizeof(Unsigned), alignment);
  for (std::size_t i = 0; i < sizeof(Unsigned); ++i) {
    const char byte = bytes[is_little_endian_ ? sizeof(Unsigned) - 1 - i : i];
    value = static_cast<Unsigned>(value << 8 | static_cast<std::uint8_t>(byte));
  }
  return value;
}

std::int32_t CdrReader::read_int32() {
  return static_cast<std::int32_t>(read_uint32());
}

std::uint32_t CdrReader::read_uint32() {
  return read_unsigned<std::uint32_t>(4);
}

float CdrReader::read_float() {
  return std::bit_cast<float>(read_uint32());
}

double CdrReader::read_double() {
  return std::bit_cast<double>(read_unsigned<std::uint64_t>(8));
}

std::string CdrReader::read_string() {
  std::string_view text = read_bytes();
  if (text.ends_with('\0')) text.remove_suffix(1);  // which its length counts
  return std::string(text);
}

std::string_view CdrReader::read_bytes() {
  const std::uint32_t count = read_uint32();
  return take(count, 1);
}

}  // namespace gridmerge::internal
