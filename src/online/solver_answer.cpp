// SPDX-License-Identifier: Apache-2.0
// What a team tells of what it found out.
#include <algorithm>
#include <memory>
#include <utility>

#include "gridmerge/merge/fuse.hpp"
#include "merge/fuse_changes.hpp"
#include "merge/joins.hpp"
#include "online/solver.hpp"
#include "online/status.hpp"

namespace gridmerge::internal {

void TeamSolver::tell_components(MergeResult result, TeamAnswer& answer) const {
  const std::vector<MapId> ids = merger_.maps();
  std::map<std::string, std::size_t> places;  // in the result
  for (std::size_t i = 0; i < ids.size(); ++i) places[names_.at(ids[i])] = i;
  struct Told {
    TeamComponent component;
    Component merged;
  };
  std::vector<Told> all;
  const std::vector<std::size_t> numbers = numbers_.number(
      placements_.groups(), ages(), std::any_of(robots_.begin(), robots_.end(), [](const auto& one) {
        return one.second.known_pose && one.second.known_pose->fixed;
      }));
  for (const RobotGroup& group : placements_.groups()) {
    Told told;
    told.component.number = numbers[all.size()];
    if (!group.in_world_frame) told.component.anchor = first_heard(group.robots);
    std::vector<PlacedMap> placed;
    for (const auto& [name, placement] : group.robots) {
      told.component.robots.push_back(name);
      placed.push_back({robots_.at(name).map.get(), placement.T_group_map});
      told.merged.members.push_back({places.at(name), placement.T_group_map, placement.probability});
    }
    std::sort(told.merged.members.begin(), told.merged.members.end(),
              [](const Member& a, const Member& b) { return a.map < b.map; });
    const bool is_weighed = std::all_of(group.robots.begin(), group.robots.end(), [&](const auto& one) {
      const Robot& robot = robots_.at(one.first);
      return robot.map == robot.weighed.map;
    });
    // What the merger fused serves where it has the newest maps, and they lie as it says.
    const auto same =
        std::find_if(result.components.begin(), result.components.end(), [&](const Component& one) {
          return is_weighed && std::equal(one.members.begin(), one.members.end(), told.merged.members.begin(),
                                          told.merged.members.end(), [](const Member& a, const Member& b) {
                                            return a.map == b.map && a.T_component_map == b.T_component_map;
                                          });
        });
    if (same != result.components.end()) {
      told.merged = std::move(*same);
    } else {
      told.merged.fused = fuse(placed, merged_resolution(options_.merge.resolution, placed));
    }
    // Another member than the first may hold the frame.
    const std::string& first = names_.at(ids[told.merged.members.front().map]);
    told.merged.in_world_frame = group.in_world_frame || first != told.component.anchor;
    told.component.map = std::make_shared<const OccupancyGrid>(std::move(told.merged.fused.grid));
    told.merged.fused.grid = {};
    all.push_back(std::move(told));
  }
  std::sort(all.begin(), all.end(),
            [](const Told& a, const Told& b) { return a.component.number < b.component.number; });
  result.components.clear();
  for (Told& told : all) {
    answer.components.push_back(std::move(told.component));
    result.components.push_back(std::move(told.merged));
  }
  answer.merge = std::make_shared<const TeamMerge>(merge_of(std::move(result)));
}

/// `result` has the answer's components.
TeamMerge TeamSolver::merge_of(MergeResult result) const {
  TeamMerge merge;
  for (const MapId id : merger_.maps()) {
    merge.names.push_back(names_.at(id));
    merge.maps.push_back(robots_.at(merge.names.back()).map);
  }
  result.left_out.clear();
  for (std::size_t i = 0; i < merge.names.size(); ++i) {
    if (is_placed(merge.names[i])) continue;
    const auto reason = left_out_.find(merge.names[i]);
    // The newest comparisons place a robot that is in no component yet: that is held back.
    result.left_out.push_back({i, reason == left_out_.end() ? Reason::several : reason->second});
  }
  merge.result = std::move(result);
  return merge;
}

RobotStatus TeamSolver::status_of(const std::string& name, const Robot& robot,
                                  const TeamAnswer& answer) const {
  const auto maps =
      std::count_if(robots_.begin(), robots_.end(), [](const auto& one) { return one.second.map; });
  RobotStatus status;
  status.name = name;
  status.maps_heard = robot.maps_heard;
  status.heard_first = robot.since;
  status.has_known_pose = robot.known_pose.has_value();
  if (const RobotGroup* const group = group_of(placements_.groups(), name)) {
    status.state = RobotState::placed;
    status.why = say_placed(name, *group);
    status.T_world_map = group->robots.at(name).T_group_map;
    status.probability = group->robots.at(name).probability;
    for (std::size_t i = 0; i < answer.components.size(); ++i) {
      const std::vector<std::string>& robots = answer.components[i].robots;
      if (std::binary_search(robots.begin(), robots.end(), name)) status.component = i;
    }
  } else if (const auto reason = left_out_.find(name); robot.map && maps > 1 && reason != left_out_.end()) {
    status.state = RobotState::left_out;
    status.reason = reason->second;
    status.why = say_left_out(status.reason);
  } else {
    status.why = say_waiting(robot.map != nullptr, maps > 1);
  }
  return status;
}

void TeamSolver::tell_events(TeamAnswer& answer) const {
  std::map<std::string, MapExtent> extents;
  for (const auto& [name, robot] : robots_) extents[name] = robot.weighed.extent;
  for (const std::string& name : restarted_)
    answer.events.push_back(
        {TeamEvent::Kind::restarted, name, say_restarted(name, lost_poses_.contains(name))});
  for (TeamEvent& event : changes_between(told_, placements_.groups(), extents, restarted_))
    answer.events.push_back(std::move(event));
  for (TeamEvent& event : renumbered_between(numbers_.told(), answer.components))
    answer.events.push_back(std::move(event));
}

std::map<std::string, TeamTime> TeamSolver::ages() const {
  std::map<std::string, TeamTime> ages;
  for (const auto& [name, robot] : robots_) ages[name] = robot.since;
  return ages;
}

const std::string& TeamSolver::first_heard(const std::map<std::string, Placement>& robots) const {
  return std::min_element(robots.begin(), robots.end(),
                          [&](const auto& a, const auto& b) {
                            return std::pair(robots_.at(a.first).since, a.first) <
                                   std::pair(robots_.at(b.first).since, b.first);
                          })
      ->first;
}

/// The poses that were told last, and of the merged maps what has changed.
void TeamSolver::draw_again(TeamAnswer& answer) const {
  answer.components = told_components_;
  answer.merge = told_merge_;
  std::vector<std::shared_ptr<const OccupancyGrid>> maps;
  for (const std::string& name : told_merge_->names) maps.push_back(robots_.at(name).map);
  if (maps == told_merge_->maps) return;
  auto merge = std::make_shared<TeamMerge>(*told_merge_);
  merge->maps = std::move(maps);
  for (std::size_t i = 0; i < answer.components.size(); ++i) {
    std::vector<PlacedMap> was, now;
    for (const Member& member : merge->result.components[i].members) {
      was.push_back({told_merge_->maps[member.map].get(), member.T_component_map});
      now.push_back({merge->maps[member.map].get(), member.T_component_map});
    }
    const auto is_same = [](const PlacedMap& a, const PlacedMap& b) { return a.map == b.map; };
    if (std::equal(was.begin(), was.end(), now.begin(), is_same)) continue;
    FusedMap& fused = merge->result.components[i].fused;
    fused.grid = *answer.components[i].map;
    fused = fuse_changes(std::move(fused), was, now, merged_resolution(options_.merge.resolution, now));
    answer.components[i].map = std::make_shared<const OccupancyGrid>(std::move(fused.grid));
    fused.grid = {};
  }
  answer.merge = std::move(merge);
}

/// Components and poses that were told last, which belong together; of what has changed since, nothing. A map
/// that is gone has no pose any more. Events are told by the answer that knows what came of them.
TeamAnswer TeamSolver::answer_before() const {
  TeamAnswer answer;
  answer.components = told_components_;
  answer.merge = told_merge_;
  for (const auto& [name, robot] : robots_) {
    RobotStatus status;
    status.why = "what was heard of it could not be merged yet";
    if (const auto told = told_robots_.find(name); told != told_robots_.end()) status = told->second;
    status.name = name;
    status.maps_heard = robot.maps_heard;
    status.heard_first = robot.since;
    status.has_known_pose = robot.known_pose.has_value();
    answer.robots.push_back(std::move(status));
  }
  return answer;
}

}  // namespace gridmerge::internal
