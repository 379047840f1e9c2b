// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "gridmerge/online/team.hpp"
#include "online/placements.hpp"

namespace gridmerge::internal {

/// Numbers of groups, from 1. Frames and topics are named after them, so a group keeps its number while
/// others come, go and grow.
class GroupNumbers {
 public:
  /// A number of each group. A number stays with the group that has the robot of it that was heard first.
  /// Where groups become one, the least of their numbers stays. Robots that lay in no group meanwhile take
  /// theirs up again if it is free. Further groups have the least free ones, by the age of their oldest
  /// robots. The group in the frame of fixed poses has number 1, and while there are such poses
  /// (`is_world_known`) no other one has. `ages` are those of all robots in groups. O(robots log robots).
  std::vector<std::size_t> number(const std::vector<RobotGroup>& groups,
                                  const std::map<std::string, TeamTime>& ages, bool is_world_known) const;

  /// These were told. What was told before of robots that lie in none is kept for as long as `ages` has them.
  void keep(const std::vector<TeamComponent>& components, const std::map<std::string, TeamTime>& ages);

  /// The number of the group that each robot was said last to lie in.
  const std::map<std::string, std::size_t>& told() const { return told_; }

 private:
  std::map<std::string, std::size_t> told_;
  std::set<std::string> placed_;  // by what was told last
};

}  // namespace gridmerge::internal
