// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <string_view>

#include "gridmerge/grid/se2.hpp"
#include "gridmerge/io/map_file.hpp"

namespace gridmerge::cli {

/// Options that every subcommand has.
struct CommonOptions {
  bool quiet = false;
  bool verbose = false;
  int threads = 0;
};

void add_common_options(CLI::App& command, CommonOptions& options);

/// What a command takes as a map.
inline constexpr std::string_view kMapHelp =
    "map_server YAML, image with --resolution, or ROS 2 bag (.mcap, .db3, folder): BAG#TOPIC, "
    "whose last map counts; the topic may be left out where only one has maps";

/// --resolution and --literal-thresholds: how files become maps.
void add_map_file_options(CLI::App& command, LoadOptions& options);

/// A number in [0, 1].
extern const CLI::Validator kProbability;

/// Digits alone.
extern const CLI::Validator kWholeNumber;

/// A finite number, 0 or more.
extern const CLI::Validator kNotNegative;

/// A resolution that a map can have.
extern const CLI::Validator kMetresPerCell;

/// The port of a server; 0 for a free one.
extern const CLI::Validator kPort;

/// One address of this machine's, to serve at. Not one that stands for all: a request has to name its host,
/// and that is no host's name.
extern const CLI::Validator kOneAddress;

/// A pose: x,y,theta in metres and radians.
extern const CLI::Validator kPose;

/// What a text that kPose lets pass says.
SE2 to_pose(const std::string& text);

}  // namespace gridmerge::cli
