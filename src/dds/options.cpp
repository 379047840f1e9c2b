// SPDX-License-Identifier: Apache-2.0
#include "dds/options.hpp"

#include <fmt/format.h>

#include <cmath>
#include <map>
#include <stdexcept>
#include <string>
#include <utility>

#include "dds/environment.hpp"
#include "dds/message.hpp"
#include "dds/names.hpp"

namespace gridmerge {

using namespace internal;

namespace {

void validate_played(const RosNodeOptions& options, const RobotSelection& selection) {
  if (!(options.play_rate > 0.0) || !std::isfinite(options.play_rate))
    throw std::invalid_argument("maps are played at a rate above 0");
  std::map<std::string, std::string> sources;
  for (const PlayedTopic& played : options.played) {
    if (!is_topic_name(played.topic))
      throw std::invalid_argument(
          fmt::format("{}: '{}' is no whole name of a topic, as /tb1/map is", played.source, played.topic));
    if (!selection.robot_of(played.topic))
      throw std::invalid_argument(
          fmt::format("{}: its topic {} is not {}", played.source, played.topic, selection.describe()));
    const auto [other, is_new] = sources.emplace(played.topic, played.source);
    if (!is_new)
      throw std::invalid_argument(
          fmt::format("{} and {} would both be played on {}", other->second, played.source, played.topic));
  }
}

}  // namespace

RosNodeOptions internal::completed(RosNodeOptions options) {
  validate(options);
  options.world_frame = read_frame(options.world_frame);
  const auto ignore = [](const std::string&) {};
  if (!options.tell) options.tell = ignore;
  if (!options.warn) options.warn = ignore;
  if (!options.detail) options.detail = ignore;
  return options;
}

RobotSelection internal::select(const RosNodeOptions& options) {
  RobotSelection selection(options.patterns, options.robots);
  for (const auto& [robot, pose] : options.known_poses)
    if (!selection.can_have(robot))
      throw std::invalid_argument(
          fmt::format("a pose is given for the robot {}, which is none of those heard", robot));
  return selection;
}

void validate(const RosNodeOptions& options) {
  if (!is_topic_name(options.output))
    throw std::invalid_argument(
        fmt::format("'{}' is no whole name of a topic, as /merged_map is", options.output));
  if (options.name.find('/') != std::string::npos || !is_topic_name("/" + options.name))
    throw std::invalid_argument(
        fmt::format("'{}' is no name of a node: letters, digits and '_'", options.name));
  if (!is_enclave_name(options.enclave))
    throw std::invalid_argument(
        fmt::format("'{}' is no enclave's name, as /robots/merger is", options.enclave));
  try {
    read_frame(options.world_frame);
  } catch (const RefusedMessage& error) {
    throw std::invalid_argument(fmt::format("the world's frame '{}': {}", options.world_frame, error.what()));
  }
  if (options.wait && !(*options.wait >= 0.0)) throw std::invalid_argument("a time to wait is 0 s or more");
  validate(options.team);
  for (const auto& [robot, pose] : options.known_poses) validate(pose);
  validate_played(options, select(options));
}

bool is_heard(const RosNodeOptions& options, const std::string& topic) {
  return RobotSelection(options.patterns, options.robots).robot_of(topic).has_value();
}

}  // namespace gridmerge
