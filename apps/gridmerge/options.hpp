// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

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

/// The whole number that `text` is: decimal digits alone, where CLI11 would read "010" as 8.
std::optional<std::uint64_t> parse_whole(std::string_view text);

/// The finite numbers that `text` is, with commas between them.
std::optional<std::vector<double>> parse_numbers(const std::string& text);

/// A number in [0, 1].
extern const CLI::Validator kProbability;

/// A whole number as parse_whole() reads it. For CLI::Option::transform(), as check() leaves the zeros in
/// front to CLI11.
CLI::Validator whole_number(std::uint64_t least = 0,
                            std::uint64_t most = std::numeric_limits<std::uint64_t>::max());

/// A finite number.
extern const CLI::Validator kNumber;

/// A finite number, 0 or more.
extern const CLI::Validator kNotNegative;

/// A resolution that a map can have.
extern const CLI::Validator kMetresPerCell;

/// Numbers of 0 or more, with commas between them.
extern const CLI::Validator kNumbersNotNegative;

/// The port of a server; 0 for a free one. For CLI::Option::transform().
extern const CLI::Validator kPort;

/// One address of this machine's, to serve at. Not one that stands for all: a request has to name its host,
/// and that is no host's name.
extern const CLI::Validator kOneAddress;

/// A pose: x,y,theta in metres and radians.
extern const CLI::Validator kPose;

/// What a text that kPose lets pass says.
SE2 to_pose(const std::string& text);

}  // namespace gridmerge::cli
