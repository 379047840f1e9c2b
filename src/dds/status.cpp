// SPDX-License-Identifier: Apache-2.0
#include "dds/status.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <set>

namespace gridmerge::internal {

namespace {

/// For people.
const char* word_for(RobotState state) {
  return state == RobotState::left_out ? "left out" : name_of(state);
}

/// The team's word on each robot that was heard; of one that it does not know yet, that it waits.
std::map<std::string, RobotStatus> statuses_of(const TeamAnswer& answer,
                                               const std::vector<HeardRobot>& robots) {
  std::map<std::string, RobotStatus> statuses;
  for (const HeardRobot& robot : robots) {
    RobotStatus waiting;
    waiting.name = robot.name;
    waiting.why = robot.maps == 0 ? "no map was heard yet" : "its first map is being looked at";
    statuses.emplace(robot.name, waiting);
  }
  for (const RobotStatus& status : answer.robots) statuses[status.name] = status;
  return statuses;
}

/// Of the component that the robot lies in.
std::size_t number_of(const TeamAnswer& answer, const RobotStatus& status) {
  return answer.components.at(*status.component).number;
}

std::string decimal(double value) {
  return fmt::format("{:.6g}", value);
}

Diagnosis diagnose_robot(const TeamAnswer& answer, const RobotStatus& status, const HeardRobot& heard,
                         const TeamTransforms& transforms, const Restarts& restarts) {
  Diagnosis diagnosis;
  diagnosis.hardware = status.name;
  diagnosis.level = status.state == RobotState::placed ? Diagnosis::ok : Diagnosis::warning;
  diagnosis.message = fmt::format("{}: {}", word_for(status.state), status.why);
  const auto withheld = transforms.withheld.find(status.name);
  if (withheld != transforms.withheld.end()) {
    diagnosis.level = Diagnosis::warning;
    diagnosis.message += "; no transform: " + withheld->second;
  }
  if (restarts.are_many(Restarts::Clock::now())) {
    diagnosis.level = Diagnosis::warning;
    diagnosis.message += "; " + say_many_restarts(heard.topic);
  }
  auto& values = diagnosis.values;
  values = {{"state", name_of(status.state)}, {kTopicKey, heard.topic}, {kFrameKey, heard.frame}};
  if (status.state == RobotState::placed && status.component) {
    values.emplace_back("component", std::to_string(number_of(answer, status)));
    values.emplace_back("x", decimal(status.T_world_map.x));
    values.emplace_back("y", decimal(status.T_world_map.y));
    values.emplace_back("theta", decimal(status.T_world_map.theta));
    values.emplace_back("probability", decimal(status.probability));
  }
  values.emplace_back("maps", std::to_string(heard.maps));
  values.emplace_back("updates", std::to_string(heard.parts));
  values.emplace_back("updates older than the map", std::to_string(heard.outdated));
  if (heard.maps > 0) {
    values.emplace_back(kPublisherKey, heard.publisher);
    values.emplace_back(kHeardFirstKey, format_time(heard.heard_first));
  }
  values.emplace_back("started anew", std::to_string(restarts.total()));
  values.emplace_back("publishers", std::to_string(heard.publishers));
  values.emplace_back("messages of other publishers", std::to_string(heard.unheard));
  values.emplace_back("refused", std::to_string(heard.refused));
  if (heard.refused > 0) values.emplace_back("last refusal", heard.last_refusal);
  return diagnosis;
}

}  // namespace

std::string component_frame(const std::string& world, std::size_t number) {
  return number == 1 ? world : fmt::format("{}_{}", world, number);
}

TeamTransforms team_transforms(const TeamAnswer& answer, const std::vector<HeardRobot>& robots,
                               const std::string& world) {
  TeamTransforms result;
  std::map<std::string, std::string> frames;             // by robot
  std::map<std::string, std::set<std::string>> sharing;  // robots by frame, placed or not
  for (const HeardRobot& robot : robots) {
    if (robot.frame.empty()) continue;
    frames[robot.name] = robot.frame;
    sharing[robot.frame].insert(robot.name);
  }
  std::set<std::string> own;
  for (const TeamComponent& component : answer.components)
    own.insert(component_frame(world, component.number));
  for (const RobotStatus& status : answer.robots) {
    const auto frame = frames.find(status.name);
    if (status.state != RobotState::placed || !status.component || frame == frames.end()) continue;
    const std::set<std::string>& robots_of_frame = sharing[frame->second];
    if (robots_of_frame.size() > 1) {
      result.withheld[status.name] =
          fmt::format("the frame {} is that of {}", frame->second, fmt::join(robots_of_frame, " and of "));
    } else if (own.contains(frame->second)) {
      result.withheld[status.name] = fmt::format("the frame {} is the merged map's own", frame->second);
    } else {
      result.transforms.push_back(
          {component_frame(world, number_of(answer, status)), frame->second, status.T_world_map});
    }
  }
  std::sort(result.transforms.begin(), result.transforms.end(),
            [](const NamedTransform& a, const NamedTransform& b) { return a.child < b.child; });
  return result;
}

std::string say_many_restarts(const std::string& topic) {
  return fmt::format("it starts anew again and again: do two robots publish on {}?", topic);
}

std::vector<Diagnosis> diagnose(const TeamAnswer& answer, const std::vector<HeardRobot>& robots,
                                const TeamTransforms& transforms, const NodeHealth& health) {
  const auto statuses = statuses_of(answer, robots);
  std::map<std::string, HeardRobot> heard;
  for (const HeardRobot& robot : robots) heard[robot.name] = robot;
  const auto placed = std::count_if(statuses.begin(), statuses.end(), [](const auto& entry) {
    return entry.second.state == RobotState::placed;
  });
  Diagnosis node;
  node.name = health.name;
  node.hardware = health.name;
  node.message = statuses.empty() ? "no robot is known yet"
                                  : fmt::format("{} of {} robots placed", placed, statuses.size());
  node.values = {{"robots", std::to_string(statuses.size())},
                 {"placed", std::to_string(placed)},
                 {"merged maps", std::to_string(answer.components.size())},
                 {"settled", answer.settled ? "yes" : "no"},
                 {"solves", std::to_string(answer.number)},
                 {"seconds of the last solve", decimal(answer.seconds)},
                 {"messages that could not be decoded", std::to_string(health.undecodable)},
                 {"warnings of DDS", std::to_string(health.dds_warnings)},
                 {"publishers beyond the limit", std::to_string(health.over_limit)}};
  if (!answer.problem.empty()) node.values.emplace_back("problem", answer.problem);
  if (health.undecodable > 0 || health.over_limit > 0 || !answer.problem.empty())
    node.level = Diagnosis::warning;
  std::vector<Diagnosis> diagnoses{node};
  for (const auto& [name, status] : statuses) {
    const auto restarts = health.restarts.find(name);
    diagnoses.push_back(diagnose_robot(answer, status, heard[name], transforms,
                                       restarts == health.restarts.end() ? Restarts() : restarts->second));
    diagnoses.back().name = fmt::format("{}: {}", health.name, name);
  }
  return diagnoses;
}

std::string explain_silence(const std::vector<HeardRobot>& robots,
                            const std::vector<std::string>& near_misses) {
  std::vector<std::string> seen;
  for (const HeardRobot& robot : robots) {
    if (robot.refused > 0)
      seen.push_back(fmt::format("{}: refused: {}", robot.topic, robot.last_refusal));
    else if (robot.publishers > 0)
      seen.push_back(robot.topic + ": is there, but nothing was received");
  }
  seen.insert(seen.end(), near_misses.begin(), near_misses.end());
  if (!seen.empty()) return fmt::format("there is {}", fmt::join(seen, "; "));
  return "no such topic is there: does ROS_DOMAIN_ID fit, and does the network let multicast through?";
}

std::string describe_team(const TeamAnswer& answer, const std::vector<HeardRobot>& robots) {
  std::string text;
  for (const auto& [name, status] : statuses_of(answer, robots)) {
    fmt::format_to(std::back_inserter(text), "{}: {}", name, word_for(status.state));
    if (status.state == RobotState::placed && status.component) {
      const SE2& T = status.T_world_map;
      fmt::format_to(std::back_inserter(text),
                     " at x {:.3f} m, y {:.3f} m, theta {:.4f} rad (probability {:.3f})", T.x, T.y, T.theta,
                     status.probability);
      if (const std::size_t number = number_of(answer, status); number > 1)
        fmt::format_to(std::back_inserter(text), " in merged map {}", number);
    } else if (!status.why.empty()) {
      text += ": " + status.why;
    }
    text += '\n';
  }
  return text;
}

}  // namespace gridmerge::internal
