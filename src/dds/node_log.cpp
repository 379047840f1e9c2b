// SPDX-License-Identifier: Apache-2.0
#include "dds/node_log.hpp"

#include <fmt/format.h>

#include <utility>

namespace gridmerge::internal {

using Clock = LineLimiter::Clock;

NodeLog::NodeLog(Write tell, Write warn)
    : told_(kEventsOfAKind, std::move(tell)), warned_(1, std::move(warn)) {}

void NodeLog::tell(const std::string& kind, const std::string& line) {
  told_.write(kind, line, Clock::now());
}

void NodeLog::warn(const std::string& kind, const std::string& line, std::uint64_t count) {
  warned_.write(kind, line, Clock::now(), count);
}

void NodeLog::tell_events(const std::vector<TeamEvent>& events) {
  for (const TeamEvent& event : events)
    tell(fmt::format("event {} {}", static_cast<int>(event.kind), event.robot), event.text);
}

void NodeLog::tell_gone(const std::vector<HeardRobot>& robots) {
  for (const HeardRobot& robot : robots) {
    if (robot.maps == 0 || robot.awaited) continue;
    std::size_t& before = publishers_[robot.name];
    if (before > 0 && robot.publishers == 0)
      tell("gone " + robot.name, robot.name + ": its publisher is gone; its map is kept");
    before = robot.publishers;
  }
}

void NodeLog::warn_of_withheld(const std::map<std::string, std::string>& withheld) {
  for (const auto& [robot, why] : withheld)
    if (!withheld_.contains(robot))
      warn("no transform " + robot, fmt::format("{}: no transform is published: {}", robot, why));
  withheld_ = withheld;
}

void NodeLog::warn_of_dds(const std::vector<Participant::LogLine>& lines) {
  for (const Participant::LogLine& line : lines) {
    warn("DDS " + line.kind, "DDS: " + line.text, line.count);
    dds_warnings_ += line.count;
  }
}

void NodeLog::tell_more() {
  told_.tell_more(Clock::now());
  warned_.tell_more(Clock::now());
}

}  // namespace gridmerge::internal
