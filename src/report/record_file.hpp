// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>

namespace gridmerge::internal {

/// MergeRecord::fingerprint of what `directory`/transforms.json holds now. Throws FileError. O(bytes).
std::uint64_t read_fingerprint(const std::filesystem::path& directory);

}  // namespace gridmerge::internal
