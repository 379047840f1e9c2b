// SPDX-License-Identifier: Apache-2.0
#include "gridmerge/io/file_error.hpp"

#include <fmt/format.h>

#include <string>

namespace gridmerge {

// A name with a line break or a terminal's escape sequence must not be able to fake or hide a message.
std::string escape_controls(std::string_view text) {
  std::string line;
  line.reserve(text.size());
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto byte = static_cast<unsigned char>(text[i]);
    const auto next = i + 1 < text.size() ? static_cast<unsigned char>(text[i + 1]) : 0u;
    if (byte == '\n') {
      line += "\\n";
    } else if (byte == '\r') {
      line += "\\r";
    } else if (byte == '\t') {
      line += "\\t";
    } else if (byte < 0x20 || byte == 0x7f) {
      line += fmt::format("\\x{:02x}", byte);
    } else if (byte == 0xc2 && next >= 0x80 && next < 0xa0) {  // U+0080 to U+009F in UTF-8
      line += fmt::format("\\x{:02x}", next);
      ++i;
    } else {
      line += text[i];
    }
  }
  return line;
}

namespace {

// Names and values are quoted from files, which may hold a megabyte of them; nobody reads that. What is cut
// is the middle, as the file stands first and the cause last. No path that can be opened is longer than 4096.
std::string shorten(std::string text) {
  constexpr std::size_t kMax = 10'000, kShown = 300;
  if (text.size() <= kMax) return text;
  return fmt::format("{} [... {} bytes ...] {}", text.substr(0, kShown), text.size() - 2 * kShown,
                     text.substr(text.size() - kShown));
}

}  // namespace

FileError::FileError(std::string_view message) : std::runtime_error(shorten(escape_controls(message))) {}

FileError::FileError(const std::filesystem::path& file, std::string_view cause)
    : FileError(fmt::format("{}: {}", file.empty() ? "''" : file.string(), cause)) {}

}  // namespace gridmerge
