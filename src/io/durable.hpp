// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "internal_export.hpp"

namespace gridmerge::internal {

/// The system's words for an errno.
std::string describe_errno(int error);

/// Writes all bytes. 0, or the errno that stopped it.
GRIDMERGE_INTERNAL_EXPORT int write_all(int descriptor, std::string_view bytes);

/// Flushes a file to the disk, or what a directory lists. 0, or an errno.
int flush_descriptor(int descriptor);

/// Flushes a file, or what a directory lists, so that a rename in it outlives a power cut. 0, or an errno.
int flush_path(const std::filesystem::path& path);

}  // namespace gridmerge::internal
