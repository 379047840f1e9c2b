// SPDX-License-Identifier: Apache-2.0
#include "dds/names.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <regex>
#include <stdexcept>
#include <string>
#include <vector>

#include "dds/selection.hpp"

namespace gridmerge::internal {
namespace {

TEST(TopicNames, AreThoseOfRos) {
  for (const char* name : {"/map", "/tb1/map", "/a/b_c/D9", "/_x"}) EXPECT_TRUE(is_topic_name(name)) << name;
  for (const char* name : {"", "/", "map", "//map", "/tb1/", "/tb1//map", "/1tb/map", "/tb-1/map",
                           "/tb 1/map", "/tb1/m\xc3\xa4p", "/*/map", "/~/map"})
    EXPECT_FALSE(is_topic_name(name)) << name;
  EXPECT_TRUE(is_topic_name("/" + std::string(kLongestTopic - 1, 'a')));
  EXPECT_FALSE(is_topic_name("/" + std::string(kLongestTopic, 'a')));
}

TEST(TopicPatterns, MatchLevelByLevel) {
  const TopicPattern usual("/*/map");
  EXPECT_TRUE(usual.matches("/tb1/map"));
  EXPECT_FALSE(usual.matches("/map"));
  EXPECT_FALSE(usual.matches("/a/b/map"));
  EXPECT_FALSE(usual.matches("/tb1/map_updates"));
  EXPECT_FALSE(usual.matches("/tb1/costmap"));
  EXPECT_TRUE(TopicPattern("/tb*_x/*map").matches("/tb12_x/costmap"));
  EXPECT_FALSE(TopicPattern("/tb*_x/*map").matches("/tb12_xy/costmap"));
  EXPECT_TRUE(TopicPattern("/**/map").matches("/a/b/c/map"));
  EXPECT_TRUE(TopicPattern("/**/map").matches("/a/map"));
  EXPECT_FALSE(TopicPattern("/**/map").matches("/map"));
  EXPECT_TRUE(TopicPattern("/a/**/*").matches("/a/b/c"));
  EXPECT_FALSE(TopicPattern("/a/**/*").matches("/a/b"));
}

TEST(TopicPatterns, ThatNoTopicCanMatchAreRefused) {
  for (const char* pattern : {"", "map", "*/map", "/", "//map", "/a//map", "/*/map/", "/1*/map", "/a b/map",
                              "/[ab]/map", "/a**/map", "/***/map"})
    EXPECT_THROW(TopicPattern{pattern}, std::invalid_argument) << pattern;
}

/// The same by a regular expression.
RC_GTEST_PROP(TopicPatterns, AgreeWithRegularExpressions, ()) {
  // Short enough for ROS.
  const auto some = [](auto element) { return rc::gen::resize(8, rc::gen::nonEmpty(element)); };
  const auto level = some(rc::gen::container<std::string>(rc::gen::element('a', 'b', '*')));
  const auto name = some(rc::gen::container<std::string>(rc::gen::element('a', 'b')));
  std::string pattern;
  std::string expression;
  for (std::string part : *some(rc::gen::container<std::vector<std::string>>(level))) {
    if (part.find("**") != std::string::npos) part = "**";
    pattern += "/" + part;
    expression += "/";
    if (part == "**") {
      expression += "[^/]+(/[^/]+)*";
      continue;
    }
    for (const char c : part) expression += c == '*' ? std::string("[^/]*") : std::string(1, c);
  }
  std::string topic;
  for (const std::string& part : *some(rc::gen::container<std::vector<std::string>>(name)))
    topic += "/" + part;
  RC_ASSERT(TopicPattern(pattern).matches(topic) == std::regex_match(topic, std::regex(expression)));
}

TEST(RobotSelection, NamesRobotsAfterNamespaces) {
  const RobotSelection selection({"/*/map", "/**/map"}, {});
  EXPECT_EQ(selection.robot_of("/tb1/map"), "tb1");
  EXPECT_EQ(selection.robot_of("/fleet/tb1/map"), "fleet/tb1");
  EXPECT_EQ(selection.robot_of("/tb1/scan"), std::nullopt);
  EXPECT_EQ(RobotSelection({"/map"}, {}).robot_of("/map"), "map");
}

TEST(RobotSelection, NamesRobotsAfterTopicsWhereNamespacesAreNotEnough) {
  const RobotSelection selection({"/*/map", "/*/static_map"}, {});
  EXPECT_EQ(selection.robot_of("/tb1/map"), "tb1/map");
  EXPECT_EQ(selection.robot_of("/tb1/static_map"), "tb1/static_map");
  EXPECT_EQ(RobotSelection({"/*/*"}, {}).robot_of("/tb1/map"), "tb1/map");
}

TEST(RobotSelection, TakesNamedRobots) {
  const RobotSelection selection({"/*/map"}, {{"left", "/tb1/map"}, {"tb2", "/other"}});
  EXPECT_EQ(selection.robot_of("/tb1/map"), "left");
  EXPECT_EQ(selection.robot_of("/other"), "tb2");
  EXPECT_EQ(selection.robot_of("/tb2/map"), "/tb2/map");  // its name is taken
  EXPECT_EQ(selection.robot_of("/tb3/map"), "tb3");
  EXPECT_TRUE(selection.can_have("anybody"));
  const RobotSelection named({}, {{"left", "/tb1/map"}});
  EXPECT_EQ(named.robot_of("/tb2/map"), std::nullopt);
  EXPECT_TRUE(named.can_have("left"));
  EXPECT_FALSE(named.can_have("right"));
}

TEST(RobotSelection, RefusesWhatCannotBe) {
  EXPECT_THROW(RobotSelection({}, {}), std::invalid_argument);
  EXPECT_THROW(RobotSelection({"/a//b"}, {}), std::invalid_argument);
  EXPECT_THROW(RobotSelection({}, {{"tb1", "map"}}), std::invalid_argument);
  EXPECT_THROW(RobotSelection({}, {{"", "/map"}}), std::invalid_argument);
  EXPECT_THROW(RobotSelection({}, {{"a", "/map"}, {"b", "/map"}}), std::invalid_argument);
}

TEST(Names, AreTranslatedBetweenRosAndDds) {
  EXPECT_EQ(ros_topic("rt/tb1/map"), "/tb1/map");
  EXPECT_EQ(dds_topic("/tb1/map"), "rt/tb1/map");
  EXPECT_EQ(ros_topic("rq/tb1/map"), std::nullopt);
  EXPECT_EQ(ros_topic("rt/tb1//map"), std::nullopt);
  EXPECT_EQ(ros_topic("rt/"), std::nullopt);
  EXPECT_EQ(ros_type("nav_msgs::msg::dds_::OccupancyGrid_"), "nav_msgs/msg/OccupancyGrid");
  EXPECT_EQ(ros_type("Plain"), "Plain");
  EXPECT_EQ(ros_type("a::msg::dds_::_"), "a/msg/");
}

}  // namespace
}  // namespace gridmerge::internal
