// SPDX-License-Identifier: Apache-2.0
// What a TeamSolver hears of explorers, and what it should say of them.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "explorers.hpp"
#include "online/solver.hpp"

namespace gridmerge::test {

using internal::News;
using internal::RobotNews;

inline const std::vector<std::string> kNames{"anna", "bert", "carl", "dora"};

inline RobotNews map_news(OccupancyGrid map, int second = 0) {
  RobotNews news;
  news.map = std::make_shared<const OccupancyGrid>(std::move(map));
  news.maps_heard = 1;
  news.since = TeamTime(std::chrono::seconds(second));
  return news;
}

inline RobotNews gone_news() {
  RobotNews news;
  news.is_gone = true;
  return news;
}

/// The maps of the first robots at a moment, heard in the order of their names. The fourth is a stranger.
inline News news_at(const Explorers& explorers, int step, int robots = 3) {
  News news;
  for (int robot = 0; robot < robots; ++robot)
    news[kNames[static_cast<std::size_t>(robot)]] = map_news(explorers.map(robot, step), robot);
  return news;
}

inline const RobotStatus& status_of(const TeamAnswer& answer, const std::string& name) {
  for (const RobotStatus& robot : answer.robots) {
    if (robot.name == name) return robot;
  }
  throw std::out_of_range(name);
}

inline bool has_event(const TeamAnswer& answer, TeamEvent::Kind kind, const std::string& robot) {
  return std::any_of(answer.events.begin(), answer.events.end(),
                     [&](const TeamEvent& event) { return event.kind == kind && event.robot == robot; });
}

/// With less in common maps are placed less exactly.
inline void expect_at(const TeamAnswer& answer, const std::string& name, const SE2& expected,
                      double tolerance = 0.15) {
  const RobotStatus& robot = status_of(answer, name);
  EXPECT_EQ(robot.state, RobotState::placed) << name << ": " << robot.why;
  EXPECT_NEAR(robot.T_world_map.x, expected.x, tolerance) << name;
  EXPECT_NEAR(robot.T_world_map.y, expected.y, tolerance) << name;
  EXPECT_NEAR(normalize_angle(robot.T_world_map.theta - expected.theta), 0.0, tolerance / 8.0) << name;
}

/// Components and robots tell one story, whichever of the two is read.
inline void expect_consistent(const TeamAnswer& answer) {
  for (const RobotStatus& robot : answer.robots) {
    EXPECT_EQ(robot.state == RobotState::placed, robot.component.has_value()) << robot.name;
    if (!robot.component) continue;
    const std::vector<std::string>& members = answer.components.at(*robot.component).robots;
    EXPECT_EQ(std::count(members.begin(), members.end(), robot.name), 1) << robot.name;
    for (const Component& component : answer.merge->result.components) {
      for (const Member& member : component.members) {
        if (answer.merge->names.at(member.map) != robot.name) continue;
        EXPECT_EQ(member.T_component_map, robot.T_world_map) << robot.name;
      }
    }
  }
}

}  // namespace gridmerge::test
