// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "dds/names.hpp"

namespace gridmerge::internal {

/// Which topics hold robots' maps, and the names of these robots.
class RobotSelection {
 public:
  /// `robots` are topics by their robots' names; they come before the patterns. Throws std::invalid_argument
  /// for a pattern or topic that ROS does not have, an empty name, a topic that two robots have, and if there
  /// is neither.
  RobotSelection(const std::vector<std::string>& patterns, std::map<std::string, std::string> robots);

  /// Whose map is on this topic; none if nobody's.
  std::optional<std::string> robot_of(const std::string& topic) const;

  /// Whether there can be a robot of this name.
  bool can_have(const std::string& robot) const;

  /// Robots that were asked for by name, with their topics.
  const std::map<std::string, std::string>& named() const { return topics_; }

  /// What is waited for, for people: "a map on /*/map".
  std::string describe() const;

 private:
  std::vector<std::string> written_;  // the patterns
  std::vector<TopicPattern> patterns_;
  std::optional<RobotNames> names_;
  std::map<std::string, std::string> topics_;  // by robot
  std::map<std::string, std::string> robots_;  // by topic
};

}  // namespace gridmerge::internal
