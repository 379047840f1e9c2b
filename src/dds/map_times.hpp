// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <string>
#include <vector>

#include "dds/message.hpp"
#include "gridmerge/online/team.hpp"

namespace gridmerge::internal {

/// The times that the maps of robots bear: an answer holds maps that were heard a while ago, and newer ones
/// were heard since.
class MapTimes {
 public:
  /// A map or an update that the team was given. An update without a time has that of what was before it.
  void hear_map(const std::string& robot, const Stamp& stamp);
  void hear_part(const std::string& robot, const Stamp& stamp);
  /// What the team is given next is the robot's first.
  void forget(const std::string& robot) { robots_.erase(robot); }

  /// The newest time in each component: of the maps that were merged, and of no others. Answers come in their
  /// order.
  std::vector<Stamp> newest_of(const TeamAnswer& answer);

  static constexpr std::size_t kMaxKept = 1024;

 private:
  struct Heard {
    std::uint64_t number = 0;  // RobotStatus::maps_heard once it is in an answer
    Stamp stamp;
  };
  struct Robot {
    std::uint64_t heard = 0;
    std::deque<Heard> times;  // from the one in the last answer on; only changes
  };

  std::map<std::string, Robot> robots_;
};

}  // namespace gridmerge::internal
