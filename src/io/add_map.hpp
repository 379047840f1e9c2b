// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "gridmerge/grid/occupancy_grid.hpp"
#include "internal_export.hpp"
#include "io/file_set.hpp"

namespace gridmerge::internal {

/// Adds the files that save_map() writes, the image first, to a set that the map belongs to. `yaml_name` has
/// no folder. Throws as save_map().
GRIDMERGE_INTERNAL_EXPORT void add_map(FileSet& files, const OccupancyGrid& grid,
                                       const std::filesystem::path& yaml_name);

/// The same of save_probability_map().
GRIDMERGE_INTERNAL_EXPORT void add_probability_map(FileSet& files, const OccupancyGrid& grid,
                                                   const std::filesystem::path& yaml_name);

/// Whether a path leads to an image, which has no YAML: a file that can be read again. False if nothing can
/// be read there.
GRIDMERGE_INTERNAL_EXPORT bool is_bare_image(const std::filesystem::path& path);

}  // namespace gridmerge::internal
