// SPDX-License-Identifier: Apache-2.0
#include "known_poses.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <set>
#include <stdexcept>
#include <system_error>

#include "console.hpp"
#include "gridmerge/io/initial_poses.hpp"

namespace gridmerge::cli {

namespace {

/// The map that is named so on the command line or, by another way, lies there.
std::optional<std::size_t> find_map(const std::vector<std::string>& maps, const std::string& name,
                                    const std::filesystem::path& path) {
  for (std::size_t i = 0; i < maps.size(); ++i) {
    std::error_code absent;
    if (std::filesystem::equivalent(path, maps[i], absent)) return i;
  }
  const auto found = std::find(maps.begin(), maps.end(), name);
  if (found == maps.end()) return std::nullopt;
  return static_cast<std::size_t>(found - maps.begin());
}

void fix(const KnownPoseOptions& options, const std::vector<std::string>& maps,
         std::vector<std::optional<KnownPose>>& known) {
  std::set<std::size_t> fixed;
  for (const std::string& name : options.fix) {
    const std::optional<std::size_t> map = find_map(maps, name, name);
    if (!map) throw std::runtime_error(fmt::format("--fix {}: is none of the maps", escape_controls(name)));
    fixed.insert(*map);
  }
  for (const std::size_t map : fixed) {
    // A single map holds its own frame; how several lie to each other has to be said.
    if (!known[map] && (fixed.size() > 1 || !options.init.empty()))
      throw std::runtime_error(
          fmt::format("--fix {}: needs a pose in a table that --init names", escape_controls(maps[map])));
    if (!known[map]) known[map] = KnownPose{};
    known[map]->fixed = true;
  }
}

}  // namespace

void add_known_pose_options(CLI::App& command, KnownPoseOptions& options) {
  command
      .add_option(
          "--init", options.init,
          "Table of poses of some or all maps (TSV: map x y theta, and optionally sd sd_theta: standard "
          "deviations, 1 m and 0.1 rad if not given)")
      ->type_name("FILE");
  command
      .add_option(
          "--fix", options.fix,
          "Take this map's pose for the truth: it is not changed, and the merged map is in its frame, or "
          "in that of --init")
      ->type_name("MAP")
      ->allow_extra_args(false);  // or it would take the maps behind it
}

std::vector<std::optional<KnownPose>> load_known_poses(const KnownPoseOptions& options,
                                                       const std::vector<std::string>& maps) {
  std::vector<std::optional<KnownPose>> known(maps.size());
  if (!options.init.empty()) {
    for (const InitialPose& pose : read_initial_poses(options.init)) {
      const std::optional<std::size_t> map = find_map(maps, pose.name, pose.path);
      if (!map) throw FileError(options.init, "'" + pose.name + "' is none of the maps to be merged");
      if (known[*map]) throw FileError(options.init, "'" + pose.name + "' is a map that it named before");
      known[*map] = KnownPose{pose.T_world_map, pose.sd, pose.sd_theta, false};
    }
  }
  fix(options, maps, known);
  return known;
}

}  // namespace gridmerge::cli
