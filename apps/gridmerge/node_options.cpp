// SPDX-License-Identifier: Apache-2.0
#include "node_options.hpp"

#include <fmt/format.h>

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <stdexcept>
#include <utility>

#include "gridmerge/bag/bag.hpp"
#include "gridmerge/io/file_error.hpp"
#include "io/number.hpp"

namespace gridmerge::cli {

using namespace internal;

namespace {

constexpr const char* kUsualPattern = "/*/map";

const CLI::Validator kNamedTopic(
    [](std::string& text) {
      const std::size_t at = text.find('=');
      const bool is_named = at != std::string::npos && at > 0 && at + 1 < text.size();
      return is_named ? std::string() : "'" + text + "' is not NAME=TOPIC, as tb1=/tb1/map";
    },
    "");

const CLI::Validator kPositiveRate(
    [](std::string& text) {
      const std::optional<double> rate = parse_number(text);
      return rate && *rate > 0.0 ? std::string() : "'" + text + "' is not a number above 0";
    },
    "");

/// "/NAME/map" of "folder/NAME.mcap"; what topics of ROS cannot have becomes '_'.
std::string topic_of_file(const std::filesystem::path& bag) {
  const bool has_slash = !bag.has_filename();  // a folder, written with a slash behind it
  std::string name = (has_slash ? bag.parent_path() : bag).stem().string();
  for (char& c : name) {
    const bool is_fine = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
    if (!is_fine) c = '_';
  }
  if (name.empty() || (name.front() >= '0' && name.front() <= '9')) name.insert(0, "_");
  return "/" + name + "/map";
}

/// The topic on which the maps of a bag's topic are played; none if they are no robot's.
std::optional<std::string> played_on(const RosNodeOptions& node, const std::string& bag,
                                     const std::string& topic) {
  if (is_heard(node, topic)) return topic;
  if (topic != "/map") return std::nullopt;
  const std::string own = topic_of_file(bag);
  return is_heard(node, own) ? std::optional(own) : std::nullopt;
}

/// The maps of a bag's topic, one after the other. Those that cannot be read are told of and passed over. The
/// first is read at once: while the node is made, no signal ends a search for it.
std::function<std::optional<PlayedMap>()> maps_of(const Bag& bag, const std::string& topic,
                                                  Console& console) {
  const auto maps = std::make_shared<BagMaps>(bag, topic);
  const auto read_next = [maps, &console]() -> std::optional<BagMap> {
    for (;;) {
      try {
        return maps->next();
      } catch (const FileError& error) {
        console.warn(error.what());
      }
    }
  };
  const auto first = std::make_shared<std::optional<BagMap>>(read_next());
  return [read_next, first]() -> std::optional<PlayedMap> {
    std::optional<BagMap> map = *first ? std::exchange(*first, std::nullopt) : read_next();
    if (!map) return std::nullopt;
    constexpr double kNanosecond = 1e-9;
    return PlayedMap{static_cast<double>(map->time) * kNanosecond, std::move(map->frame_id),
                     std::move(map->grid)};
  };
}

const std::map<std::string, TransformTopic>& transform_topics() {
  static const std::map<std::string, TransformTopic> topics{
      {"static", TransformTopic::tf_static}, {"dynamic", TransformTopic::tf}, {"none", TransformTopic::none}};
  return topics;
}

/// --pattern and --robot: whom it hears.
void add_robot_options(CLI::App& command, NodeCommandOptions& options) {
  command
      .add_option(
          "--pattern", options.patterns,
          fmt::format("Topics of maps: '*' stands for any characters between two slashes, a level '**' for "
                      "any levels. {} if neither this nor --robot is given; repeat it for others",
                      kUsualPattern))
      ->type_name("PATTERN");
  command
      .add_option(
          "--robot", options.robots,
          "A robot's name and the topic of its map; repeat it for others. Robots found by a pattern are "
          "named after their topic's namespace")
      ->type_name("NAME=TOPIC")
      ->check(kNamedTopic);
}

/// --init and --fix, of robots.
void add_robot_pose_options(CLI::App& command, NodeCommandOptions& options) {
  command
      .add_option(
          "--init", options.known.init,
          "Poses that you know, of some or all robots' map frames: a table (TSV) with the columns map x y "
          "theta, where map is the robot's name, as of 'gridmerge merge'")
      ->type_name("FILE");
  command
      .add_option(
          "--fix", options.known.fix,
          "Keep this robot's map where it is. The merged map takes its frame, or that of --init, if given. "
          "Repeat it for others. Each of several needs a pose in --init")
      ->option_text("ROBOT");
}

/// What it publishes under which name, and where.
void add_published_options(CLI::App& command, NodeCommandOptions& options) {
  RosNodeOptions& node = options.node;
  command
      .add_option("--world", node.world_frame,
                  "The frame of the merged map; further merged maps have it with _2, _3, ...")
      ->type_name("FRAME")
      ->capture_default_str();
  command
      .add_option("--output", node.output, "Topic of the merged map; further ones have it with _2, _3, ...")
      ->type_name("TOPIC")
      ->capture_default_str();
  command.add_option("--name", node.name, "The node's name, as ROS's tools show it")
      ->type_name("NODE")
      ->capture_default_str();
  command
      .add_option("--enclave", node.enclave,
                  "The node's enclave, as /robots/merger, where ROS_SECURITY_ENABLE is true")
      ->type_name("NAME")
      ->capture_default_str();
  command
      .add_option(
          "--tf", options.transforms,
          "Transforms from the world to the robots' map frames: static on /tf_static when they change, "
          "dynamic on /tf ten times per second, or none")
      ->type_name("WHERE")
      ->check(CLI::IsMember(transform_topics()).description(""))
      ->capture_default_str();
}

/// How maps are merged.
void add_merge_options(CLI::App& command, NodeCommandOptions& options) {
  RosNodeOptions& node = options.node;
  command
      .add_option("--accept", options.search.accept,
                  fmt::format("Probability from which on two maps are joined; {} if not given",
                              MatchOptions{}.accept_probability))
      ->type_name("P")
      ->check(kProbability);
  command
      .add_option(
          "--max-false-joins", node.team.merge.max_false_joins,
          "How many joins of the whole team may be expected to be false; those that are least sure are not "
          "made")
      ->type_name("NUMBER")
      ->check(kNotNegative)
      ->capture_default_str();
  command
      .add_option(
          "--output-resolution", node.team.merge.resolution,
          "Metres per cell of the merged map; if not given, those of the finest map, or so many more, "
          "up to 16 times, that it has at most 2^28 cells")
      ->type_name("METRES")
      ->check(kMetresPerCell);
}

/// --bag and --rate: recordings.
void add_bag_options(CLI::App& command, NodeCommandOptions& options) {
  RosNodeOptions& node = options.node;
  CLI::Option* bag =
      command
          .add_option(
              "--bag", options.bags,
              "A recording of ROS 2 (.mcap, .db3 or a rosbag2 folder) whose maps are published as the robot "
              "did, and merged; repeat it for others. /map of FILE.mcap becomes /FILE/map. All begin at once")
          ->type_name("BAG");
  command.add_option("--rate", node.play_rate, "Seconds of the recordings per second, with --bag")
      ->type_name("NUMBER")
      ->check(kPositiveRate)
      ->needs(bag)
      ->capture_default_str();
}

/// --page and --page-address.
void add_page_options(CLI::App& command, NodeCommandOptions& options) {
  CLI::Option* page = command
                          .add_option("--page", options.page,
                                      "Serve a report page that follows along at this port; 0 = a free one")
                          ->type_name("PORT")
                          ->transform(kPort);
  command
      .add_option("--page-address", options.page_address,
                  "Address or name of this machine to serve the page at; others can reach it unless it is a "
                  "loopback one")
      ->type_name("ADDRESS")
      ->check(kOneAddress)
      ->needs(page)
      ->capture_default_str();
}

/// --once and --wait: when it ends by itself.
void add_end_options(CLI::App& command, NodeCommandOptions& options) {
  RosNodeOptions& node = options.node;
  command.add_flag(
      "--once", node.once,
      "End when the maps of all robots that are there are merged; the exit code is that of 'merge'");
  command
      .add_option(
          "--wait", node.wait,
          "End with an error if no map has come within this time; for ever if not given, 10 with --once, "
          "which waits so long for further robots too")
      ->type_name("SECONDS")
      ->check(kNotNegative);
}

}  // namespace

void add_node_options(CLI::App& command, NodeCommandOptions& options) {
  add_robot_options(command, options);
  add_robot_pose_options(command, options);
  add_published_options(command, options);
  add_merge_options(command, options);
  add_bag_options(command, options);
  add_page_options(command, options);
  add_end_options(command, options);
  add_common_options(command, options.common);
}

RosNodeOptions to_node_options(const NodeCommandOptions& options) {
  RosNodeOptions node = options.node;
  node.patterns = options.patterns;
  if (options.patterns.empty() && options.robots.empty()) node.patterns = {kUsualPattern};
  for (const std::string& robot : options.robots) {
    const std::size_t at = robot.find('=');
    if (!node.robots.emplace(robot.substr(0, at), robot.substr(at + 1)).second)
      throw CLI::ValidationError("--robot", "names the robot " + robot.substr(0, at) + " twice");
  }
  for (const std::string& robot : options.known.fix) node.known_poses[robot].fixed = true;
  node.transforms = transform_topics().at(options.transforms);
  node.team.merge.match = match_options(options.common, options.search);
  try {
    validate(node);
  } catch (const std::invalid_argument& error) {
    throw CLI::ValidationError(error.what());
  }
  return node;
}

std::vector<PlayedTopic> played_topics(const NodeCommandOptions& options, const RosNodeOptions& node,
                                       Console& console) {
  std::vector<PlayedTopic> played;
  for (const std::string& file : options.bags) {
    const Bag bag(file);
    std::vector<std::string> others;
    const std::size_t before = played.size();
    for (const BagTopic& topic : bag.map_topics()) {
      const std::optional<std::string> on = played_on(node, file, topic.name);
      if (on) {
        played.push_back({*on, file + "#" + topic.name, maps_of(bag, topic.name, console), file});
      } else {
        others.push_back(topic.name);
      }
    }
    const std::string list = fmt::format("{}", fmt::join(others, ", "));
    if (played.size() == before)
      throw FileError(file, others.empty() ? "has no topic of maps (nav_msgs/msg/OccupancyGrid)"
                                           : fmt::format("has maps on {} only; --pattern says which topics "
                                                         "are maps of robots",
                                                         list));
    if (!others.empty()) console.remark(fmt::format("{}: not played: {}", file, list));
  }
  return played;
}

std::map<std::string, KnownPose> known_robot_poses(const NodeCommandOptions& options, Console& console) {
  const auto name_of = [](const std::string& name, const std::filesystem::path&) {
    return std::optional(name);  // robots may come that nobody has heard of
  };
  std::map<std::string, KnownPose> known;
  for (const auto& [robot, given] : read_given_poses(options.known, name_of, console))
    known[robot] = given.pose;
  return known;
}

}  // namespace gridmerge::cli
