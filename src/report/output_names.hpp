// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>

#include "internal_export.hpp"

namespace gridmerge::internal {

inline constexpr const char* kTransforms = "transforms.json";
inline constexpr std::size_t kMaxRecordBytes = std::size_t{256} << 20;  // of a transforms.json

/// Whether a file of this name in the output directory is a merge's own: written, replaced or removed by it.
GRIDMERGE_INTERNAL_EXPORT bool is_merge_output(const std::filesystem::path& name);

/// What a file is called that each merged map has one of, for merged map `component`, from 0 on: the first
/// has the name itself, the next is file_2, as the merged maps are.
std::filesystem::path numbered(const std::filesystem::path& file, std::size_t component);

/// Of which merged map, from 1 on, `name` is the file, both without folders; none where it is no such name.
std::optional<std::size_t> number_in(const std::filesystem::path& name, const std::filesystem::path& file);

/// Whether numbered(file, ...) may be `name`, both without folders.
GRIDMERGE_INTERNAL_EXPORT bool is_numbered(const std::filesystem::path& name,
                                           const std::filesystem::path& file);

}  // namespace gridmerge::internal
