// SPDX-License-Identifier: Apache-2.0
#include "report/escaped_bytes.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cstddef>

namespace gridmerge::internal {

namespace {

constexpr std::size_t kEscape = 4;  // "\xe9"

/// The number of bytes of the character that a text begins with; 0 if these are none.
std::size_t character_bytes(std::string_view text) {
  const auto byte = [&](std::size_t i) { return i < text.size() ? static_cast<unsigned char>(text[i]) : 0U; };
  const unsigned lead = byte(0);
  if (lead < 0x80) return text.empty() ? 0 : 1;
  if (lead < 0xc2 || lead > 0xf4) return 0;
  const unsigned least = lead == 0xe0 ? 0xa0 : lead == 0xf0 ? 0x90 : 0x80;  // below, fewer bytes would do
  const unsigned most = lead == 0xed ? 0x9f : lead == 0xf4 ? 0x8f : 0xbf;   // above is no character
  if (byte(1) < least || byte(1) > most) return 0;
  const std::size_t length = lead >= 0xf0 ? 4 : lead >= 0xe0 ? 3 : 2;
  for (std::size_t i = 2; i < length; ++i) {
    if (byte(i) < 0x80 || byte(i) > 0xbf) return 0;
  }
  return length;
}

}  // namespace

bool is_utf8(std::string_view text) {
  while (!text.empty()) {
    const std::size_t length = character_bytes(text);
    if (length == 0) return false;
    text.remove_prefix(length);
  }
  return true;
}

std::string escape_bytes(std::string_view text) {
  std::string escaped;
  while (!text.empty()) {
    const std::size_t length = character_bytes(text);
    if (length == 0) {
      escaped += fmt::format("\\x{:02x}", static_cast<unsigned char>(text.front()));
      text.remove_prefix(1);
      continue;
    }
    if (text.front() == '\\') escaped += '\\';
    escaped += text.substr(0, length);
    text.remove_prefix(length);
  }
  return escaped;
}

std::optional<std::string> unescape_bytes(std::string_view text) {
  std::string bytes;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '\\') {
      bytes += text[i];
    } else if (text.substr(i, 2) == "\\\\") {
      bytes += text[++i];
    } else {
      const std::string_view escape = text.substr(i, kEscape);
      unsigned byte = 0;
      const char* const end = escape.data() + escape.size();
      if (escape.size() < kEscape || escape[1] != 'x' ||
          std::from_chars(escape.data() + 2, end, byte, 16).ptr != end)
        return std::nullopt;
      bytes += static_cast<char>(byte);
      i += kEscape - 1;
    }
  }
  // Other bytes have no escape, and a character has none.
  return escape_bytes(bytes) == text ? std::optional(bytes) : std::nullopt;
}

}  // namespace gridmerge::internal
