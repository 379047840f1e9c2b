// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "gridmerge/export.hpp"
#include "gridmerge/grid/se2.hpp"
#include "gridmerge/io/file_error.hpp"

namespace gridmerge {

/// What a file of initial poses says of one map.
struct InitialPose {
  std::string name;               ///< of the map, as the file writes it
  std::filesystem::path path;     ///< the same, relative to the file's folder
  double theta_as_written = 0.0;  ///< [rad], not normalized: what is more than a turn may be degrees
  SE2 T_world_map;                ///< takes the map's frame, its YAML's origin applied, to the world's
  double sd_position = 1.0;       ///< standard deviation of the map's position [m]: column `sd`
  double sd_theta = 0.1;          ///< standard deviation of theta [rad]
};

/// Reads a tab-separated table whose first line names the columns: `map x y theta`, and optionally `sd` and
/// `sd_theta`; metres and radians. Throws FileError that says "file:line: cause" for what it cannot use, a
/// map named twice and deviations that are not from 10^-6 to 10^5 among it.
GRIDMERGE_EXPORT std::vector<InitialPose> read_initial_poses(const std::filesystem::path& path);

/// The same of the file's text.
GRIDMERGE_EXPORT std::vector<InitialPose> parse_initial_poses(const std::filesystem::path& path,
                                                              std::string_view text);

}  // namespace gridmerge
