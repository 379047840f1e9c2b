// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "gridmerge/export.hpp"
#include "gridmerge/grid/occupancy_grid.hpp"
#include "gridmerge/grid/se2.hpp"
#include "gridmerge/match/match_result.hpp"
#include "gridmerge/merge/merge_result.hpp"

namespace gridmerge {

/// When something was heard.
using TeamTime = std::chrono::system_clock::time_point;

/// What a team knows of a robot.
enum class RobotState {
  waiting,   ///< there is nothing yet that it could be compared with
  placed,    ///< it lies in a component
  left_out,  ///< it was compared with the others, and lies nowhere surely enough
};

/// As outputs spell it: "waiting", "placed", "left_out".
GRIDMERGE_EXPORT const char* name_of(RobotState state);

/// A robot of a team.
struct RobotStatus {
  std::string name;                        ///< what Team::hear() calls it
  RobotState state = RobotState::waiting;  ///< what is known of it
  Reason reason = Reason::none;            ///< why it was left out
  std::string why;                         ///< the state in a few words, for people
  /// Place in TeamAnswer::components; none for a robot that lies in none.
  std::optional<std::size_t> component = {};
  SE2 T_world_map;               ///< takes the map's frame to its component's; the identity for one in none
  double probability = 0.0;      ///< that it lies there
  std::uint64_t maps_heard = 0;  ///< maps and parts of maps, those that changed nothing too
  TeamTime heard_first = {};     ///< since when it is heard, by the oldest account
};

/// Robots that were placed together.
struct TeamComponent {
  /// The robot whose map frame is the component's: the one heard first, for as long as it lives. Empty where
  /// poses are fixed: the frame is then theirs.
  std::string anchor;
  std::vector<std::string> robots;           ///< ascending; two or more
  std::shared_ptr<const OccupancyGrid> map;  ///< all their maps, fused; never null
};

/// What stands behind an answer, as a merge that outputs can show (NamedMerge).
struct TeamMerge {
  std::vector<std::string> names;  ///< of the robots with maps, in the order in which they came
  std::vector<std::shared_ptr<const OccupancyGrid>> maps;  ///< the newest of each, never null
  /// Components, poses and their order are the answer's, comparisons those of the maps that were weighed
  /// last: while the answer holds a change back, the two may differ. The fused grids are empty:
  /// TeamComponent::map has them.
  MergeResult result;
};

/// What has changed from one answer to the next.
struct TeamEvent {
  /// What kind of change it is.
  enum class Kind {
    joined,    ///< the robot was placed
    left,      ///< the robot was placed, and is no longer
    jumped,    ///< the robot lies elsewhere than it was said to
    restarted  ///< the robot's map is another one than before, in another frame
  };

  Kind kind = Kind::joined;  ///< what happened
  std::string robot;         ///< to whom
  std::string text;          ///< one line for people, that names the robot
};

/// What a team knows at one moment.
struct TeamAnswer {
  std::uint64_t number = 0;               ///< counts up; 0 is the answer before anything was heard
  std::vector<TeamComponent> components;  ///< most robots first, then by name
  std::vector<RobotStatus> robots;        ///< by name
  std::vector<TeamEvent> events;          ///< since the answer before
  double seconds = 0.0;                   ///< that it took to find out
  /// The newest maps were searched as merge() does, nothing is held against them: the components and poses
  /// are those of merge() with these maps, in the order of first hearing.
  bool settled = true;
  std::shared_ptr<const TeamMerge> merge = std::make_shared<const TeamMerge>();  ///< never null
  /// Why this is the answer before, made again; empty where there is none. Such an answer is never settled.
  std::string problem;
};

/// TeamAnswer::merge with the fused grids: as merge() would give it, for outputs. O(cells of the merged
/// maps).
GRIDMERGE_EXPORT MergeResult merge_result(const TeamAnswer& answer);

}  // namespace gridmerge
