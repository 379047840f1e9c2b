// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "gridmerge/merge/merger.hpp"
#include "gridmerge/online/team.hpp"
#include "merge/coverage.hpp"
#include "online/group_numbers.hpp"
#include "online/placements.hpp"

namespace gridmerge::internal {

/// What was heard of a robot since it was asked last.
struct RobotNews {
  std::shared_ptr<const OccupancyGrid> map;  ///< the newest; null where there is none
  std::uint64_t maps_heard = 0;
  std::optional<TeamTime> since;                       ///< when it was heard first, by the oldest account
  bool is_gone = false;                                ///< before all the rest of this
  std::optional<std::optional<KnownPose>> known_pose;  ///< what is known now, where that has changed
  /// The newest that was heard before `known_pose` was: in its frame the pose counts. Null where none waited.
  std::shared_ptr<const OccupancyGrid> map_of_pose;
};

/// All that was heard, by robot.
using News = std::map<std::string, RobotNews>;

/// Adds later news to earlier ones. Of a robot that is gone nothing earlier counts. A known pose counts for
/// the map before it, and is lost with a later map that starts anew.
void add_news(RobotNews& earlier, RobotNews later);

/// The team without its thread: takes news, and says what follows from them. The same news in the same steps
/// give the same answers.
class TeamSolver {
 public:
  /// Throws std::invalid_argument for options that make no sense.
  explicit TeamSolver(const TeamOptions& options);

  /// What is to be heeded by the next solve(). O(1) each.
  void take(News news);

  /// How far solve() goes.
  enum class Effort {
    soon,     ///< all news, and quick looks at what they changed
    further,  ///< some thorough looks that are still due
    full,     ///< every map is searched that has changed since it was, and what follows is taken at once
  };

  /// The answer with all news. It has the number of the one before where only RobotStatus::maps_heard
  /// differs. May be cancelled: nothing of the news is lost then, nor what was searched. Where it fails
  /// otherwise, the answer is the one before, and says why; it is not settled then.
  TeamAnswer solve(Effort effort);

  /// Whether Effort::further has nothing to do.
  bool is_complete() const { return merger_.is_complete(); }

  /// Whether nothing is left to find out: an answer in full would be the same.
  bool is_settled() const;

 private:
  using MapId = Merger::MapId;

  /// A map that the merger has.
  struct Weighed {
    std::shared_ptr<const OccupancyGrid> map;
    MapExtent extent;
    CellCounts counts;
  };

  struct Robot {
    TeamTime since = TeamTime::max();               ///< when it was heard first
    std::optional<MapId> id;                        ///< in the merger; none before a map came
    std::shared_ptr<const OccupancyGrid> map;       ///< the newest, which is drawn
    Weighed weighed;                                ///< the one from which its pose was found
    std::shared_ptr<const OccupancyGrid> searched;  ///< the map when it was searched last
    std::uint64_t maps_heard = 0;
    std::optional<KnownPose> known_pose;
  };

  bool find_out(Effort effort, TeamAnswer& answer);
  void weigh_again(Effort effort, TeamAnswer& answer);
  void draw_again(TeamAnswer& answer) const;
  TeamAnswer answer_before() const;
  void apply(const std::string& name, RobotNews& news);
  void set_map(const std::string& name, std::shared_ptr<const OccupancyGrid> map);
  bool may_lie_with_copies(const std::string& name) const;
  bool is_drawn_only(const std::string& name, const Robot& robot, const OccupancyGrid& map) const;
  static Weighed to_be_weighed(std::shared_ptr<const OccupancyGrid> map);
  void weigh(const std::string& name, Robot& robot, std::shared_ptr<const OccupancyGrid> map);
  void begin_to_weigh(const std::string& name);
  void weigh_what_changed();
  void remove(const std::string& name);
  bool is_placed(const std::string& name) const;
  void search_what_changed();
  void propose(const MergeResult& result, Placements::Weight weight);
  void tell_components(MergeResult result, TeamAnswer& answer) const;
  TeamMerge merge_of(MergeResult result) const;
  RobotStatus status_of(const std::string& name, const Robot& robot, const TeamAnswer& answer) const;
  void tell_events(TeamAnswer& answer) const;
  std::map<std::string, TeamTime> ages() const;
  const std::string& first_heard(const std::map<std::string, Placement>& robots) const;

  TeamOptions options_;
  Merger merger_;
  News pending_;
  std::map<std::string, Robot> robots_;
  std::map<MapId, std::string> names_;
  Placements placements_;
  bool is_weighed_ = true;            // all that poses may follow from, by the last answer
  std::set<std::string> fresh_;       // with newer maps since the last proposal
  std::set<std::string> restarted_;   // since the last answer
  std::set<std::string> lost_poses_;  // of these, whose known pose holds no longer
  std::map<std::string, Reason> left_out_;
  std::vector<RobotGroup> told_;  // by the last answer that had no problem, as what follows
  std::vector<TeamComponent> told_components_;
  GroupNumbers numbers_;
  std::map<std::string, RobotStatus> told_robots_;  // without those whose map is another one since
  std::shared_ptr<const TeamMerge> told_merge_ = std::make_shared<const TeamMerge>();
  bool told_settled_ = true;   // by the last answer
  bool has_problem_ = false;   // likewise
  std::uint64_t answers_ = 0;  // that differ
};

}  // namespace gridmerge::internal
