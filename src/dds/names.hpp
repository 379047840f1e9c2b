// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace gridmerge::internal {

/// Whether ROS takes this as the whole name of a topic: levels of letters, digits and underscores, each
/// behind a slash, none of them beginning with a digit; at most kLongestTopic characters.
bool is_topic_name(std::string_view name);

inline constexpr std::size_t kLongestTopic = 247;  // ROS's own limit

/// Topics whose names look so: a `*` stands for any characters of one level, none among them, and a level
/// `**` for one or more whole levels.
class TopicPattern {
 public:
  /// Throws std::invalid_argument for a pattern that no topic's name can match, saying why.
  explicit TopicPattern(std::string pattern);

  /// O(pattern * name).
  bool matches(std::string_view topic) const;

  /// The last level if it has no `*`.
  std::optional<std::string> last_level() const;

 private:
  std::string pattern_;
};

/// Names of the robots whose maps are on topics. It is the topic's namespace (`tb1` of `/tb1/map`) where all
/// patterns end in one and the same level, so that no two topics have one name; a topic outside of any
/// namespace has its own name. Elsewhere the robot's name is the topic's without the first slash.
class RobotNames {
 public:
  explicit RobotNames(const std::vector<TopicPattern>& patterns);

  std::string operator()(std::string_view topic) const;

 private:
  bool by_namespace_ = true;
};

/// The name in ROS of a topic of DDS; none if it is no topic of ROS's.
std::optional<std::string> ros_topic(std::string_view dds_topic);

/// The name in DDS of a topic of ROS.
std::string dds_topic(std::string_view ros_topic);

/// `nav_msgs/msg/OccupancyGrid` for `nav_msgs::msg::dds_::OccupancyGrid_`; a type that is not ROS's as it is.
std::string ros_type(std::string_view dds_type);

}  // namespace gridmerge::internal
