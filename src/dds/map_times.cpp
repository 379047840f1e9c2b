// SPDX-License-Identifier: Apache-2.0
#include "dds/map_times.hpp"

#include <algorithm>

namespace gridmerge::internal {

void MapTimes::hear_map(const std::string& robot, const Stamp& stamp) {
  Robot& heard = robots_[robot];
  ++heard.heard;
  if (!heard.times.empty() && heard.times.back().stamp == stamp) return;
  heard.times.push_back({heard.heard, stamp});
  // An answer may take long. The first one stays: it is that of the last answer.
  if (heard.times.size() > kMaxKept) heard.times.erase(heard.times.begin() + 1);
}

void MapTimes::hear_part(const std::string& robot, const Stamp& stamp) {
  const std::deque<Heard>& times = robots_[robot].times;
  hear_map(robot, stamp == Stamp{} && !times.empty() ? times.back().stamp : stamp);
}

std::vector<Stamp> MapTimes::newest_of(const TeamAnswer& answer) {
  std::vector<Stamp> newest(answer.components.size());
  for (const RobotStatus& status : answer.robots) {
    const auto robot = robots_.find(status.name);
    if (robot == robots_.end()) continue;
    std::deque<Heard>& times = robot->second.times;
    while (times.size() > 1 && times[1].number <= status.maps_heard) times.pop_front();
    if (status.component && !times.empty() && times.front().number <= status.maps_heard)
      newest.at(*status.component) = std::max(newest.at(*status.component), times.front().stamp);
  }
  return newest;
}

}  // namespace gridmerge::internal
