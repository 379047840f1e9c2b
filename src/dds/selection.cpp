// SPDX-License-Identifier: Apache-2.0
#include "dds/selection.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace gridmerge::internal {

RobotSelection::RobotSelection(const std::vector<std::string>& patterns,
                               std::map<std::string, std::string> robots)
    : written_(patterns), topics_(std::move(robots)) {
  if (patterns.empty() && topics_.empty())
    throw std::invalid_argument("neither patterns nor robots are given");
  for (const std::string& pattern : patterns) patterns_.emplace_back(pattern);
  names_.emplace(patterns_);
  for (const auto& [robot, topic] : topics_) {
    if (robot.empty()) throw std::invalid_argument(fmt::format("the robot of {} has no name", topic));
    if (!is_topic_name(topic))
      throw std::invalid_argument(fmt::format("'{}' is no whole name of a topic, as /tb1/map is", topic));
    const auto [entry, is_new] = robots_.emplace(topic, robot);
    if (!is_new)
      throw std::invalid_argument(
          fmt::format("{} is the map of two robots: {} and {}", topic, entry->second, robot));
  }
}

std::optional<std::string> RobotSelection::robot_of(const std::string& topic) const {
  const auto named = robots_.find(topic);
  if (named != robots_.end()) return named->second;
  const bool matches = std::any_of(patterns_.begin(), patterns_.end(),
                                   [&](const TopicPattern& pattern) { return pattern.matches(topic); });
  if (!matches) return std::nullopt;
  std::string robot = (*names_)(topic);
  // A name that was given to another topic is taken: the whole topic tells them apart.
  if (topics_.contains(robot)) robot = topic;
  return robot;
}

bool RobotSelection::can_have(const std::string& robot) const {
  return !patterns_.empty() || topics_.contains(robot);
}

std::string RobotSelection::describe() const {
  std::vector<std::string> wanted = written_;
  for (const auto& [robot, topic] : topics_) wanted.push_back(topic);
  return fmt::format("a map (nav_msgs/msg/OccupancyGrid) on {}", fmt::join(wanted, ", "));
}

}  // namespace gridmerge::internal
