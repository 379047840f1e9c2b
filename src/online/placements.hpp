// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "gridmerge/grid/se2.hpp"
#include "merge/map_extent.hpp"

namespace gridmerge::internal {

/// Where a robot lies in a group.
struct Placement {
  SE2 T_group_map;           ///< takes the robot's map frame to the group's
  double probability = 0.0;  ///< that it lies there
};

/// Robots that lie together, in one frame.
struct RobotGroup {
  std::map<std::string, Placement> robots;  ///< by name
  bool in_world_frame = false;              ///< the frame is that of fixed poses
};

/// The group that a robot lies in; null if there is none. O(groups * log robots).
const RobotGroup* group_of(const std::vector<RobotGroup>& groups, const std::string& robot);

/// Groups of robots that change by evidence, not by every whim: what was said before is given up for
/// something that contradicts it only when that was said often enough in a row.
class Placements {
 public:
  explicit Placements(int confirmations) : confirmations_(confirmations) {}

  const std::vector<RobotGroup>& groups() const { return groups_; }

  /// Whether the newest proposal is not what groups() says.
  bool is_held_back() const { return is_held_back_; }

  /// Robots of whose pose nothing is known any more.
  void forget(const std::string& robot);

  /// Takes in what the newest maps say. Two robots contradict it that lay together and now lie apart, or
  /// otherwise than bent maps explain. Groups that share robots with such a pair, in either answer, stay as
  /// they were until the same contradiction was proposed `confirmations` times in a row while one of `fresh`,
  /// the robots with newer maps, was among them; or until a proposal is `conclusive`. A `partial` one did not
  /// look at all pairs: that robots lie apart in it is no contradiction, and they stay together. `extents`
  /// are those of all robots' maps. O(robots^2).
  enum class Weight { partial, full, conclusive };
  void propose(std::vector<RobotGroup> proposed, const std::set<std::string>& fresh,
               const std::map<std::string, MapExtent>& extents, Weight weight);

 private:
  using Pair = std::pair<std::string, std::string>;

  void add_missing(std::vector<RobotGroup>& proposed) const;

  /// That two robots do not lie as they did.
  struct Contradiction {
    bool apart = true;  ///< nor together
    SE2 T_first_second;
    int times = 0;
  };

  int confirmations_;
  std::vector<RobotGroup> groups_;
  std::map<Pair, Contradiction> contradictions_;
  bool is_held_back_ = false;
};

}  // namespace gridmerge::internal
