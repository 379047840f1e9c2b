// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <stdexcept>
#include <string>
#include <string_view>

#include "gridmerge/export.hpp"

namespace gridmerge {

/// The text with control characters shown as escapes, so that it is one line of a terminal whatever it holds.
/// What is escaped already stays as it is.
GRIDMERGE_EXPORT std::string escape_controls(std::string_view text);

/// A file that cannot be read or written. The message names the file and the cause, on one line:
/// "a.yaml: missing key 'origin'". Control characters (file names and file contents are not ours to choose)
/// are shown as escapes. Of a message above 10,000 bytes the middle is left out.
class GRIDMERGE_EXPORT FileError : public std::runtime_error {
 public:
  /// The message as it is, but for control characters and length.
  explicit FileError(std::string_view message);
  /// "file: cause"; of a name that is empty "'': cause".
  FileError(const std::filesystem::path& file, std::string_view cause);
};

}  // namespace gridmerge
