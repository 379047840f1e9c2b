// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "console.hpp"
#include "gridmerge/dds/ros_node.hpp"
#include "known_poses.hpp"
#include "options.hpp"
#include "search_options.hpp"

namespace gridmerge::cli {

/// What the command line of `gridmerge node` says.
struct NodeCommandOptions {
  CommonOptions common;
  std::vector<std::string> patterns;
  std::vector<std::string> robots;  // NAME=TOPIC
  KnownPoseOptions known;           // of robots
  std::vector<std::string> bags;    // files and folders that are played
  std::string transforms = "static";
  std::optional<int> page;  // port of the page that follows along
  std::string page_address = "127.0.0.1";
  RosNodeOptions node;  // except for what is above and below
  SearchOptions search;
};

/// All of them, with checks of what one option alone can get wrong.
void add_node_options(CLI::App& command, NodeCommandOptions& options);

/// What a node takes, without the poses of --init. Throws CLI::ValidationError for what cannot be.
RosNodeOptions to_node_options(const NodeCommandOptions& options);

/// The topics of maps that --bag says: of those of a bag, the ones that are robots' maps. Tells of the
/// others. Throws FileError for a bag that cannot be read, or that has none.
std::vector<PlayedTopic> played_topics(const NodeCommandOptions& options, const RosNodeOptions& node,
                                       Console& console);

/// What --init and --fix say. Throws and warns as read_given_poses().
std::map<std::string, KnownPose> known_robot_poses(const NodeCommandOptions& options, Console& console);

}  // namespace gridmerge::cli
