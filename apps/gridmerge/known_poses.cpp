// SPDX-License-Identifier: Apache-2.0
#include "known_poses.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <stdexcept>
#include <utility>

#include "console.hpp"
#include "gridmerge/bag/bag.hpp"
#include "gridmerge/io/initial_poses.hpp"
#include "shown_command.hpp"

namespace gridmerge::cli {

using namespace internal;

namespace {

/// The map that lies there, by whatever way, or that the command line names so.
std::optional<std::string> name_among(const std::vector<std::string>& maps, const std::string& name,
                                      const std::filesystem::path& path) {
  const auto same =
      std::find_if(maps.begin(), maps.end(), [&](const std::string& map) { return is_same_map(path, map); });
  if (same != maps.end()) return *same;
  return std::find(maps.begin(), maps.end(), name) == maps.end() ? std::nullopt : std::optional(name);
}

/// What to write in place of so many degrees.
std::string in_radians(double degrees) {
  return fmt::format(" ({} degrees are {:.4f})", degrees,
                     normalize_angle(degrees * std::numbers::pi / 180.0));
}

/// How far a pose is from another one: "3.2 m and 40 degrees".
std::string offset_text(double distance, double angle) {
  constexpr double kToldFrom = 0.5;  // degrees
  const double degrees = angle * 180.0 / std::numbers::pi;
  return fmt::format("{:.3g} m{}", distance,
                     degrees < kToldFrom ? "" : fmt::format(" and {:.3g} degrees", degrees));
}

std::map<std::string, GivenPose> read_table(const std::string& table, const MapNamer& name_of,
                                            Console& console) {
  std::map<std::string, GivenPose> given;
  for (const InitialPose& pose : read_initial_poses(table)) {
    const std::optional<std::string> map = name_of(pose.name, pose.path);
    if (!map) throw FileError(table, "'" + pose.name + "' is none of the maps to be merged");
    const KnownPose known{pose.T_world_map, pose.sd_position, pose.sd_theta, false};
    if (!given.emplace(*map, GivenPose{known, pose.theta_as_written}).second)
      throw FileError(table, "'" + pose.name + "' is a map that it named before");
    if (std::abs(pose.theta_as_written) > 2.0 * std::numbers::pi)
      console.warn(fmt::format("{}: theta of {} is {}, more than a turn: it must be in radians{}", table,
                               pose.name, pose.theta_as_written, in_radians(pose.theta_as_written)));
  }
  return given;
}

std::runtime_error wrong_fix(const std::string& map, const char* cause) {
  return std::runtime_error(fmt::format("--fix {}: {}", escape_controls(map), cause));
}

void fix(const KnownPoseOptions& options, const MapNamer& name_of, std::map<std::string, GivenPose>& given) {
  std::vector<std::string> fixed;
  for (const std::string& name : options.fix) {
    const std::optional<std::string> map = name_of(name, name);
    if (!map) throw wrong_fix(name, "is none of the maps");
    if (std::find(fixed.begin(), fixed.end(), *map) != fixed.end()) throw wrong_fix(*map, "is named twice");
    fixed.push_back(*map);
  }
  // A single map holds its own frame; how several lie to each other has to be said.
  const bool needs_poses = fixed.size() > 1 || !options.init.empty();
  for (const std::string& map : fixed) {
    if (needs_poses && !given.contains(map))
      throw wrong_fix(map, "needs a pose in a table that --init names");
    given[map].pose.fixed = true;
  }
}

}  // namespace

void add_known_pose_options(CLI::App& command, KnownPoseOptions& options) {
  command
      .add_option(
          "--init", options.init,
          "Poses that you know, of some or all maps: a table (TSV) with the columns map x y theta, "
          "in metres and radians, and if you like sd sd_theta, their standard deviations (1 m and 0.1 rad if "
          "not given). "
          "Sure poses join maps that share nothing. A pose that the merge does not follow is named")
      ->type_name("FILE");
  command
      .add_option("--fix", options.fix,
                  "Keep this map where it is. The merged map takes its frame, or that of --init, if given. "
                  "The option names one map; repeat it for others. Each of several needs a pose in --init")
      ->option_text("MAP");
}

std::map<std::string, GivenPose> read_given_poses(const KnownPoseOptions& options, const MapNamer& name_of,
                                                  Console& console) {
  std::map<std::string, GivenPose> given;
  if (!options.init.empty()) given = read_table(options.init, name_of, console);
  fix(options, name_of, given);
  if (given.size() == 1 && !given.begin()->second.pose.fixed)
    console.warn(
        fmt::format("{}: one pose alone says nothing about how maps lie: give that of another one too, "
                    "or --fix {}",
                    options.init, typed_file(given.begin()->first)));
  return given;
}

KnownPoses::KnownPoses(const KnownPoseOptions& options, const std::vector<std::string>& maps,
                       Console& console)
    : table_(options.init), names_(maps), poses_(maps.size()) {
  const auto name_of = [&](const std::string& name, const std::filesystem::path& path) {
    return name_among(maps, name, path);
  };
  for (const auto& [name, given] : read_given_poses(options, name_of, console)) {
    // Of a map that is given twice the first one counts.
    const auto map = static_cast<std::size_t>(std::find(maps.begin(), maps.end(), name) - maps.begin());
    poses_[map] = given.pose;
    if (given.theta_as_written) written_[map] = *given.theta_as_written;
  }
}

std::string KnownPoses::describe_unused(const std::vector<OccupancyGrid>& maps, const MergeResult& result,
                                        const LoadOptions& load) const {
  std::string text;
  for (const ContradictedFix& fix : find_contradicted_fixes(maps, poses_, result)) {
    text += fmt::format("{}: --fix keeps it {} from where it fits {}: the maps contradict the given poses\n",
                        escape_controls(names_[fix.moving]), offset_text(fix.distance, fix.angle),
                        escape_controls(names_[fix.fixed]));
  }
  for (const LeftOut& one : result.left_out) {
    if (poses_[one.map] && poses_[one.map]->fixed)
      text += fmt::format(
          "{}: --fix has no effect, as the map is left out\n"
          "try: --init with its pose and that of another map, and --fix both\n",
          escape_controls(names_[one.map]));
  }
  const std::vector<UnusedPose> all = find_unused_poses(maps, poses_, result);
  std::set<std::pair<std::size_t, std::size_t>> told;  // pairs whose poses are not used
  for (const UnusedPose& unused : all) {
    const bool is_pair =
        unused.why == UnusedPose::Why::not_sure_enough || unused.why == UnusedPose::Why::against_match;
    if (!is_pair || told.insert(std::minmax(unused.map, unused.other)).second)
      text += describe(unused, load) + "\n";
  }
  if (!all.empty() && would_do_in_degrees(maps, result, all.size()))
    text += fmt::format(
        "{}: its theta look like degrees, with which more of its poses are true: it must be in "
        "radians\n",
        escape_controls(table_));
  return text;
}

std::string KnownPoses::describe(const UnusedPose& unused, const LoadOptions& load) const {
  const std::string name = escape_controls(names_[unused.map]);
  const std::string other = escape_controls(names_[unused.other]);
  const KnownPose& pose = *poses_[unused.map];
  const auto remedy = [&] {
    return fmt::format("--fix {} --fix {} takes them for the truth", typed_file(names_[unused.other]),
                       typed_file(names_[unused.map]));
  };
  switch (unused.why) {
    case UnusedPose::Why::overruled:
      return fmt::format("{}: the given pose is not believed: {} from where the maps fit", name,
                         offset_text(unused.distance, unused.angle));
    case UnusedPose::Why::not_sure_enough:
      return fmt::format(
          "{}: the given pose is not sure enough to be used alone: beside that of {}\n"
          "     it may be off by {:.2g} m (sd {} m, sd_theta {} rad), and {:.2g} m are allowed\n"
          "try: sd and sd_theta in {} for both, at most {:.2g} times these,\n"
          "     or {}",
          name, other, unused.sd, pose.sd_position, pose.sd_theta, unused.sd_allowed, escape_controls(table_),
          unused.sd_allowed / unused.sd, remedy());
    case UnusedPose::Why::against_match:
      return fmt::format(
          "{}: the given pose is {} from where the map surely fits {} without it: one of the two is "
          "wrong\n"
          "try: {}   (where it fits), or {}",
          name, offset_text(unused.distance, unused.angle), other,
          match_command(names_[unused.other], names_[unused.map], load), remedy());
    case UnusedPose::Why::contradicted:
      break;
  }
  return fmt::format(
      "{}: the given pose is not used: what the maps say contradicts it,\n"
      "     or more is asked of a join than poses give\n"
      "try: {}",
      name, remedy());
}

/// Whether fewer poses would be unused were the table's angles degrees.
bool KnownPoses::would_do_in_degrees(const std::vector<OccupancyGrid>& maps, const MergeResult& result,
                                     std::size_t unused) const {
  std::vector<std::optional<KnownPose>> in_degrees = poses_;
  for (const auto& [map, theta] : written_)
    in_degrees[map]->T_world_map.theta = normalize_angle(theta * std::numbers::pi / 180.0);
  return find_unused_poses(maps, in_degrees, result).size() < unused;
}

}  // namespace gridmerge::cli
