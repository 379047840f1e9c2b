// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "internal_export.hpp"

namespace gridmerge::internal {

/// Whether a file of this name in the output directory is a merge's own: written, replaced or removed by it.
GRIDMERGE_INTERNAL_EXPORT bool is_merge_output(const std::filesystem::path& name);

}  // namespace gridmerge::internal
