// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <vector>

#include "gridmerge/merge/known_pose.hpp"

namespace gridmerge::cli {

/// What the command line says of where maps lie.
struct KnownPoseOptions {
  std::string init;              // file of initial poses
  std::vector<std::string> fix;  // maps, as the command line names them
};

/// --init and --fix.
void add_known_pose_options(CLI::App& command, KnownPoseOptions& options);

/// For each map what is known of its pose. Throws FileError when the file is no table of poses or names a map
/// that is not among these, and std::runtime_error when a map that is to be fixed is not, or needs a pose and
/// has none.
std::vector<std::optional<KnownPose>> load_known_poses(const KnownPoseOptions& options,
                                                       const std::vector<std::string>& maps);

}  // namespace gridmerge::cli
