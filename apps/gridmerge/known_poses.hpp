// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "console.hpp"
#include "gridmerge/merge/known_pose.hpp"
#include "gridmerge/merge/merge_result.hpp"

namespace gridmerge::cli {

/// What the command line says of where maps lie.
struct KnownPoseOptions {
  std::string init;              // file of initial poses
  std::vector<std::string> fix;  // maps, as the command line names them
};

/// --init and --fix.
void add_known_pose_options(CLI::App& command, KnownPoseOptions& options);

/// What is known beforehand of where the maps lie.
class KnownPoses {
 public:
  /// Throws FileError when the file is no table of poses or names a map that is not among `maps`, and
  /// std::runtime_error when a map that is to be fixed is not, or needs a pose and has none. Warns of angles
  /// that look like degrees.
  KnownPoses(const KnownPoseOptions& options, const std::vector<std::string>& maps, Console& console);

  /// For each map, as merge() takes it.
  const std::vector<std::optional<KnownPose>>& poses() const { return poses_; }

  /// Lines that name the poses that the merge did not follow, why, and what to do; and those that it followed
  /// against what the maps say.
  std::string describe_unused(const std::vector<OccupancyGrid>& maps, const MergeResult& result) const;

 private:
  std::string describe(const UnusedPose& unused) const;
  bool would_do_in_degrees(const std::vector<OccupancyGrid>& maps, const MergeResult& result,
                           std::size_t unused) const;

  std::string table_;               // the name of the file of initial poses
  std::vector<std::string> names_;  // of all maps
  std::vector<std::optional<KnownPose>> poses_;
  std::map<std::size_t, double> written_;  // theta of maps that the table names, as it stands there
};

}  // namespace gridmerge::cli
