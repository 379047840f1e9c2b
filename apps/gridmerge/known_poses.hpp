// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "console.hpp"
#include "gridmerge/merge/merge.hpp"
#include "gridmerge/merge/merge_result.hpp"
#include "merge/unused_poses.hpp"

namespace gridmerge::cli {

/// What the command line says of where maps lie.
struct KnownPoseOptions {
  std::string init;              // file of initial poses
  std::vector<std::string> fix;  // maps or robots, as the command line names them
};

/// --init and --fix, of maps that are given as files.
void add_known_pose_options(CLI::App& command, KnownPoseOptions& options);

/// What the command line says of one map.
struct GivenPose {
  KnownPose pose;
  std::optional<double> theta_as_written;  // in the table, if that names the map
};

/// The one name of the map that is called so, or that lies at this path; none if there is no such map.
using MapNamer =
    std::function<std::optional<std::string>(const std::string& name, const std::filesystem::path& path)>;

/// What --init and --fix say, by the names that `name_of` gives. Throws FileError when the file is no table
/// of poses, or names no map or one a second time. Throws std::runtime_error when a map that is to be fixed
/// is not there, is named twice, or needs a pose and has none. Warns of angles that look like degrees.
std::map<std::string, GivenPose> read_given_poses(const KnownPoseOptions& options, const MapNamer& name_of,
                                                  Console& console);

/// What is known beforehand of where the maps lie.
class KnownPoses {
 public:
  /// Of `maps`, as the command line names them. Throws and warns as read_given_poses().
  KnownPoses(const KnownPoseOptions& options, const std::vector<std::string>& maps, Console& console);

  /// For each map, as merge() takes it.
  const std::vector<std::optional<KnownPose>>& poses() const { return poses_; }

  /// Lines that name the poses that the merge did not follow, why, and what to do; and those that it followed
  /// against what the maps say.
  /// `load` is how the maps were read.
  std::string describe_unused(const std::vector<OccupancyGrid>& maps, const MergeResult& result,
                              const LoadOptions& load) const;

 private:
  std::string describe(const internal::UnusedPose& unused, const LoadOptions& load) const;
  bool would_do_in_degrees(const std::vector<OccupancyGrid>& maps, const MergeResult& result,
                           std::size_t unused) const;

  std::string table_;               // the name of the file of initial poses
  std::vector<std::string> names_;  // of all maps
  std::vector<std::optional<KnownPose>> poses_;
  std::map<std::size_t, double> written_;  // theta of maps that the table names, as it stands there
};

}  // namespace gridmerge::cli
