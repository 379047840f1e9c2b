// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "internal_export.hpp"

namespace gridmerge::internal {

/// Throws FileError unless nothing is at `path` or a regular file, by whichever link: a rename would put a
/// file in the place of a device such as /dev/null, for everybody.
GRIDMERGE_INTERNAL_EXPORT void check_destination(const std::filesystem::path& path);

}  // namespace gridmerge::internal
