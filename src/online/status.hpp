// SPDX-License-Identifier: Apache-2.0
// What people are told of robots.
#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include "gridmerge/online/team.hpp"
#include "online/placements.hpp"

namespace gridmerge::internal {

std::string say_placed(const std::string& robot, const RobotGroup& group);
std::string say_left_out(Reason reason);
std::string say_waiting(bool has_map, bool has_others);
std::string say_restarted(const std::string& robot, bool loses_pose);

/// What became of robots from one answer's groups to the next one's: who joined, left and jumped, by name.
/// Of two robots that lie otherwise than before the one jumped that lies otherwise to most of those that it
/// lay together with. `extents` are those of all robots that there are now, and `restarted` those of them
/// whose frame is another one than before. O(robots^2).
std::vector<TeamEvent> changes_between(const std::vector<RobotGroup>& before,
                                       const std::vector<RobotGroup>& now,
                                       const std::map<std::string, MapExtent>& extents,
                                       const std::set<std::string>& restarted);

/// Whose components have another number than the one that was told: an event for each number before and now.
std::vector<TeamEvent> renumbered_between(const std::map<std::string, std::size_t>& before,
                                          const std::vector<TeamComponent>& now);

}  // namespace gridmerge::internal
