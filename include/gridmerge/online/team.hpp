// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "gridmerge/export.hpp"
#include "gridmerge/grid/occupancy_grid.hpp"
#include "gridmerge/grid/se2.hpp"
#include "gridmerge/match/match_result.hpp"
#include "gridmerge/merge/merge.hpp"
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
  /// Since when it is heard, by the oldest account; TeamTime::max() for one that was not heard, but of whose
  /// pose something is known.
  TeamTime heard_first = {};
  bool has_known_pose = false;  ///< one was set, and its map has not started anew since (Team::hear)

  /// Whether all of it is the same.
  friend bool operator==(const RobotStatus&, const RobotStatus&) = default;
};

/// Robots that were placed together.
struct TeamComponent {
  /// What frames and topics are named after, from 1. It stays while components come, go and grow. The one in
  /// the frame of fixed poses has 1, and no other one has while there are such poses. A component that is
  /// made of several has their least. Otherwise it goes with the robot that was heard first. Numbers that no
  /// component has any more are given anew, so there may be gaps.
  std::size_t number = 1;
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
    joined,     ///< the robot was placed
    left,       ///< the robot was placed, and is no longer
    jumped,     ///< the robot lies elsewhere than it was said to
    restarted,  ///< the robot's map is another one than before, in another frame
    renumbered  ///< the robot, and perhaps others, lie in a component of another number (TeamComponent)
  };

  Kind kind = Kind::joined;  ///< what happened
  std::string robot;         ///< to whom
  std::string text;          ///< one line for people; the robot's name stands in it as it was given
};

/// What a team knows at one moment.
struct TeamAnswer {
  /// Counts up; 0 is the answer before anything was heard. One that differs from the answer before in
  /// RobotStatus::maps_heard alone has its number.
  std::uint64_t number = 0;
  std::vector<TeamComponent> components;  ///< by number
  std::vector<RobotStatus> robots;        ///< by name
  std::vector<TeamEvent> events;          ///< since the answer before
  double seconds = 0.0;                   ///< that it took to find out
  /// The newest maps were searched as merge() does, nothing is held against them: the components and poses
  /// are those of merge() with these maps, in the order of first hearing; components are by number.
  bool settled = true;
  std::shared_ptr<const TeamMerge> merge = std::make_shared<const TeamMerge>();  ///< never null
  /// Why this is the answer before, made again; empty where there is none. Such an answer is never settled.
  std::string problem;
};

/// TeamAnswer::merge with the fused grids: as merge() would give it, for outputs, but with components by
/// number. So the first need not be the largest. O(cells of the merged maps).
GRIDMERGE_EXPORT MergeResult merge_result(const TeamAnswer& answer);

/// How a team works.
struct TeamOptions {
  MergeOptions merge;  ///< as of merge(); only rigid, and its progress callback is not used
  /// A map is searched anew when this share of its known cells differs from when it was searched last. A
  /// quarter of it is enough for a robot that lies nowhere yet. In between, the pose follows the map
  /// once a fiftieth of its cells or walls is new. A smaller change is drawn at once where the robot lies.
  double search_again = 0.1;
  /// A robot that was placed is moved elsewhere, or taken out, when so many answers in a row, each with newer
  /// maps, say so in the same way.
  int confirmations = 3;
  /// With no newer map for so long, all that is left is searched, and what that says is taken at once. From 0
  /// to a year.
  std::chrono::milliseconds quiet{3000};
  std::size_t max_robots = 256;  ///< Team::hear() refuses more
};

/// Throws std::invalid_argument for options that make no sense.
GRIDMERGE_EXPORT void validate(const TeamOptions& options);

/// Robots that map while they are heard, come and go, and know nothing of each other's frames.
///
/// A thread of its own merges the newest map of each, never a queue of old ones. All methods may be called
/// from any thread, and none waits for that work, except where it says so. Memory is bounded by the maps:
/// six of each robot at most, and two more while a known pose of a newer map waits.
///
/// Answers are steady. A robot's pose follows the evidence, but a robot that was placed moves elsewhere only
/// when that is confirmed (TeamOptions::confirmations, TeamOptions::quiet), and each jump is reported. A
/// component's frame is that of the robot that was heard first, for as long as it lives.
class GRIDMERGE_EXPORT Team {
 public:
  /// Is given each answer of a new number or with a new problem, by the team's thread, one after the other,
  /// when answer() and take_events() have it already; must not throw, nor call the team's destructor. The
  /// team is at work until it returns, so in it wait_until_settled() says false when its time is over. A
  /// robot that is forgotten at the very moment at which it is called may still have its pose in what it is
  /// given.
  using OnAnswer = std::function<void(const std::shared_ptr<const TeamAnswer>&)>;

  /// Throws std::invalid_argument for options that make no sense.
  explicit Team(TeamOptions options = {}, OnAnswer on_answer = {});
  /// Ends what is at work, within a fraction of a second.
  ~Team();
  Team(const Team&) = delete;             ///< a team has a thread of its own
  Team& operator=(const Team&) = delete;  ///< likewise

  /// The robot's newest map. A map that differs too much from the one before is that of a robot which
  /// started anew in another frame: what was known of its pose is forgotten. A known pose is kept if most
  /// walls are where they were, as where a closed loop bent the map. Throws std::invalid_argument for an
  /// invalid map or a robot too many. O(cells).
  void hear(const std::string& robot, OccupancyGrid map);

  /// New cells of a rectangle of the robot's newest map, with cell (`column`, `row`) at its lower left
  /// corner; `part.resolution` and `part.origin` have to be valid, and play no role beyond that. Returns
  /// false, and does nothing, where there is no map that holds them. Throws std::invalid_argument for an
  /// invalid part. O(cells of the map).
  bool hear_part(const std::string& robot, int column, int row, const OccupancyGrid& part);

  /// Another node of the same team has heard the robot since then (RobotStatus::heard_first of its answer).
  /// Nodes that tell each other agree on who was heard first, so on frames, though they heard robots in
  /// another order or started anew. Of a robot without a map it says nothing.
  void hear_age(const std::string& robot, TeamTime heard_first);

  /// The robot is gone, and its map with it. From now on no RobotStatus of answer() has a pose that is of
  /// this map. Components, their maps and TeamAnswer::merge go without it from the next answer on. O(robots).
  void forget(const std::string& robot);

  /// What is known of where a robot's map lies, heard or not yet. It counts for the newest map that was heard
  /// before, and holds until the map starts anew (hear()). Throws std::invalid_argument as merge(), and for a
  /// robot too many.
  void set_known_pose(const std::string& robot, std::optional<KnownPose> known_pose);

  /// The newest, never null.
  std::shared_ptr<const TeamAnswer> answer() const;

  /// What has changed since this was called last, oldest first: the events of every answer, those too that
  /// nobody asked for. Of more than 1000 the newest are kept. For whoever has no callback.
  std::vector<TeamEvent> take_events();

  /// Waits until all that was heard is settled, or for so long, a year at most; says whether it is.
  bool wait_until_settled(std::chrono::milliseconds longest) const;

  /// Whether nothing more follows from what was heard: answer() is settled, or stays as TeamAnswer::problem
  /// says until there is something new.
  bool is_at_rest() const;

 private:
  class Worker;
  std::unique_ptr<Worker> worker_;
};

}  // namespace gridmerge
