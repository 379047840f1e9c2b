// SPDX-License-Identifier: Apache-2.0
#include "shown_command.hpp"

#include <fmt/format.h>

#include "report/escaped_bytes.hpp"

namespace gridmerge::cli {

using namespace internal;

namespace {

/// In '...'; a text that a terminal may not show as it is in $'...', as bash has it.
std::string quoted(const std::string& text) {
  const bool is_shown = is_utf8(text) && escape_controls(text) == text;
  std::string word = is_shown ? "'" : "$'";
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '\'') {
      word += is_shown ? "'\\''" : "\\'";
    } else if (is_shown) {
      word += c;
    } else {
      word += byte < 0x20 || byte >= 0x7f || c == '\\' ? fmt::format("\\x{:02x}", byte) : std::string(1, c);
    }
  }
  return word + "'";
}

}  // namespace

std::string typed_file(const std::string& name) {
  constexpr const char* kBare = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789+,-./:=@_#%";
  const std::string file = name.starts_with('-') ? "./" + name : name;
  const bool is_bare =
      !file.empty() && !file.starts_with('#') && file.find_first_not_of(kBare) == std::string::npos;
  return is_bare ? file : quoted(file);
}

std::string match_command(const std::string& fixed, const std::string& moving, const LoadOptions& load) {
  std::string command = fmt::format("gridmerge match {} {}", typed_file(fixed), typed_file(moving));
  if (load.resolution != 0.0) command += fmt::format(" --resolution {}", load.resolution);
  if (load.literal_thresholds) command += " --literal-thresholds";
  return command;
}

}  // namespace gridmerge::cli
