// SPDX-License-Identifier: Apache-2.0
#include "online/status.hpp"

#include <algorithm>
#include <cstdio>

#include "merge/left_out.hpp"
#include "merge/map_extent.hpp"

namespace gridmerge::internal {

namespace {

SE2 between(const RobotGroup& group, const std::string& first, const std::string& second) {
  return inverse(group.robots.at(first).T_group_map) * group.robots.at(second).T_group_map;
}

std::string listed(const std::vector<std::string>& names) {
  constexpr std::size_t kNamed = 4;
  std::string text;
  for (std::size_t i = 0; i < std::min(kNamed, names.size()); ++i) text += (i == 0 ? "" : ", ") + names[i];
  return names.size() > kNamed ? text + " and " + std::to_string(names.size() - kNamed) + " more" : text;
}

std::string others_of(const std::string& robot, const RobotGroup& group) {
  std::vector<std::string> others;
  for (const auto& [name, placement] : group.robots) {
    if (name != robot) others.push_back(name);
  }
  return listed(others);
}

std::string metres(double distance) {
  char text[32];
  std::snprintf(text, sizeof text, "%.1f m", distance);
  return text;
}

/// How far a robot lies from where it was to those that it lay together with, if it lies elsewhere to most.
double jump_of(const std::string& robot, const RobotGroup& before, const RobotGroup& now,
               const std::map<std::string, MapExtent>& extents) {
  std::size_t common = 0, elsewhere = 0;
  double farthest = 0.0;
  for (const auto& [other, placement] : before.robots) {
    if (other == robot || !now.robots.contains(other)) continue;
    ++common;
    const MapExtent &a = extents.at(other), &b = extents.at(robot);
    const SE2 T_before = between(before, other, robot), T_now = between(now, other, robot);
    if (difference(a, b, T_before, T_now) <= agreement_tolerance(a, b)) continue;
    ++elsewhere;
    farthest = std::max(farthest, displacement(b, T_before, T_now));
  }
  return 2 * elsewhere > common ? farthest : 0.0;
}

}  // namespace

std::string say_placed(const std::string& robot, const RobotGroup& group) {
  return "it lies together with " + others_of(robot, group);
}

std::string say_left_out(Reason reason) {
  return explain_left_out(reason);
}

std::string say_waiting(bool has_map, bool has_others) {
  if (!has_map) return "no map came yet";
  return has_others ? "what is new is not confirmed yet" : "there is no other map yet";
}

std::string say_restarted(const std::string& robot, bool loses_pose) {
  return robot + " started anew: its map does not go on from the one before, and is searched anew" +
         (loses_pose ? "; the pose given for it holds no longer" : "");
}

std::vector<TeamEvent> changes_between(const std::vector<RobotGroup>& before,
                                       const std::vector<RobotGroup>& now,
                                       const std::map<std::string, MapExtent>& extents,
                                       const std::set<std::string>& restarted) {
  std::vector<RobotGroup> steady = before;  // a new frame says nothing of where others lay
  for (RobotGroup& group : steady)
    std::erase_if(group.robots, [&](const auto& one) { return restarted.contains(one.first); });
  std::vector<TeamEvent> events;
  for (const auto& [robot, extent] : extents) {
    const RobotGroup *lay = group_of(steady, robot), *lies = group_of(now, robot);
    if (lies && !lay) {
      events.push_back({TeamEvent::Kind::joined, robot, robot + " joined " + others_of(robot, *lies)});
    } else if (lay && !lies) {
      events.push_back(
          {TeamEvent::Kind::left, robot,
           robot + " is no longer sure to lie with " + others_of(robot, *group_of(before, robot))});
    } else if (lay && lies) {
      const double jump = jump_of(robot, *lay, *lies, extents);
      if (jump > 0.0)
        events.push_back({TeamEvent::Kind::jumped, robot,
                          robot + " moved by " + metres(jump) + ": its newer place is confirmed"});
    }
  }
  for (const RobotGroup& group : before) {
    for (const auto& [robot, placement] : group.robots) {
      if (!extents.contains(robot))
        events.push_back({TeamEvent::Kind::left, robot, robot + " is gone, and its map with it"});
    }
  }
  return events;
}

std::vector<TeamEvent> renumbered_between(const std::map<std::string, std::size_t>& before,
                                          const std::vector<TeamComponent>& now) {
  std::vector<TeamEvent> events;
  for (const TeamComponent& component : now) {
    std::map<std::size_t, std::vector<std::string>> movers;  // by the number before
    for (const std::string& robot : component.robots) {
      const auto told = before.find(robot);
      if (told != before.end() && told->second != component.number) movers[told->second].push_back(robot);
    }
    for (const auto& [number, robots] : movers)
      events.push_back({TeamEvent::Kind::renumbered, robots.front(),
                        listed(robots) + ": now in merged map " + std::to_string(component.number) +
                            ", before in merged map " + std::to_string(number)});
  }
  return events;
}

}  // namespace gridmerge::internal
