// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <new>

#include "gridmerge/io/file_error.hpp"
#include "io/parse_error.hpp"

namespace gridmerge::internal {

/// Calls `parse`, and tells which file it was about when that fails: throws FileError in place of ParseError
/// and of std::bad_alloc.
template <typename Parse>
auto blaming(const std::filesystem::path& path, const Parse& parse) {
  try {
    return parse();
  } catch (const ParseError& error) {
    throw FileError(path, error.what());
  } catch (const std::bad_alloc&) {
    throw FileError(path, "the map needs more memory than there is");
  }
}

}  // namespace gridmerge::internal
