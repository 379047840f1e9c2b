// SPDX-License-Identifier: Apache-2.0
#include "online/solver.hpp"

#include <algorithm>
#include <chrono>
#include <stdexcept>
#include <utility>

#include "grid/equal_grids.hpp"
#include "gridmerge/grid/cancellation.hpp"
#include "gridmerge/grid/resample.hpp"
#include "gridmerge/merge/fuse.hpp"
#include "merge/joins.hpp"
#include "online/robot_map.hpp"
#include "online/status.hpp"

namespace gridmerge::internal {

namespace {

/// A robot that lies nowhere yet is searched for sooner: it is waited for.
constexpr double kSooner = 0.25;
/// Thorough looks until the next answer, which newer maps may wait for: a second or two on two cores.
constexpr std::size_t kPairsAtATime = 4;

MergeOptions without_progress(MergeOptions options) {
  options.progress = nullptr;
  options.match.progress = nullptr;
  return options;
}

MapExtent extent_of(const OccupancyGrid& map) {
  return count_cells(map).known() == 0 ? MapExtent{} : Coverage(crop_to_known(map)).extent();
}

}  // namespace

void add_news(RobotNews& earlier, RobotNews later) {
  if (later.is_gone) {  // with all that was heard before: later news begin anew
    earlier = RobotNews{};
    earlier.is_gone = true;
  }
  if (later.map) earlier.map = std::move(later.map);
  if (later.known_pose) earlier.known_pose = later.known_pose;
  if (later.since) earlier.since = std::min(earlier.since.value_or(TeamTime::max()), *later.since);
  earlier.maps_heard += later.maps_heard;
}

TeamSolver::TeamSolver(const TeamOptions& options)
    : options_(options), merger_(without_progress(options.merge)), placements_(options.confirmations) {
  validate(options);
}

void TeamSolver::take(News news) {
  for (auto& entry : news) add_news(pending_[entry.first], std::move(entry.second));
}

TeamAnswer TeamSolver::solve(Effort effort) {
  const auto start = std::chrono::steady_clock::now();
  TeamAnswer answer;
  try {
    find_out(effort, answer);
  } catch (const Cancelled&) {
    throw;
  } catch (const std::exception& error) {  // a merged map would be too large, or there is no memory for it
    answer = answer_before();
    answer.problem = error.what();
  }
  answer.number = ++answers_;
  answer.settled = answer.problem.empty() && is_settled();
  answer.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return answer;
}

void TeamSolver::find_out(Effort effort, TeamAnswer& answer) {
  while (!pending_.empty()) {
    // In the order of their names; each is done with before it is forgotten.
    const auto next = pending_.begin();
    apply(next->first, next->second);
    pending_.erase(next);
  }
  const bool in_full = effort == Effort::full;
  if (in_full) search_what_changed();
  MergeResult result =
      in_full ? merger_.solve() : merger_.solve_soon(effort == Effort::soon ? 0 : kPairsAtATime);
  using Weight = Placements::Weight;
  propose(result, in_full ? Weight::conclusive : is_complete() ? Weight::full : Weight::partial);
  tell_components(std::move(result), answer);
  for (const auto& [name, robot] : robots_) answer.robots.push_back(status_of(name, robot, answer));
  tell_events(answer);
  told_ = placements_.groups();
  told_components_ = answer.components;
  told_merge_ = answer.merge;
  told_robots_.clear();
  for (const RobotStatus& robot : answer.robots) told_robots_[robot.name] = robot;
  restarted_.clear();
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
    answer.robots.push_back(std::move(status));
  }
  return answer;
}

bool TeamSolver::is_settled() const {
  if (!pending_.empty() || placements_.is_held_back() || !is_complete()) return false;
  return std::all_of(robots_.begin(), robots_.end(),
                     [](const auto& robot) { return robot.second.map == robot.second.searched; });
}

void TeamSolver::apply(const std::string& name, RobotNews& news) {
  if (news.is_gone) {
    remove(name);
    news.is_gone = false;
  }
  if (news.known_pose) {
    Robot& robot = robots_.try_emplace(name, Robot{}).first->second;
    robot.known_pose = *news.known_pose;
    if (robot.id) merger_.set_known_pose(*robot.id, robot.known_pose);
    placements_.forget(name);
    news.known_pose.reset();
  }
  if (news.since) {
    Robot& robot = robots_.try_emplace(name, Robot{}).first->second;
    robot.since = std::min(robot.since, *news.since);
  }
  if (news.map) set_map(name, news.map);
  if (const auto robot = robots_.find(name); robot != robots_.end())
    robot->second.maps_heard += news.maps_heard;
}

void TeamSolver::set_map(const std::string& name, std::shared_ptr<const OccupancyGrid> map) {
  Robot& robot = robots_[name];
  if (!robot.id) {
    const MapExtent extent = extent_of(*map);
    robot.id = merger_.add(*map, robot.known_pose);
    names_[*robot.id] = name;
    robot.searched = map;
    robot.map = std::move(map);
    robot.extent = extent;
    fresh_.insert(name);
    return;
  }
  if (are_equal(*robot.map, *map)) return;
  const MapChange change = change_between(*robot.map, *map);
  const bool other_frame = change.other_frame;
  const double searched_from = options_.search_again * (is_placed(name) ? 1.0 : kSooner);
  // Mostly the map before is the one that was searched last.
  const double unsearched =
      robot.searched == robot.map ? change.share : change_between(*robot.searched, *map).share;
  const bool searches = other_frame || unsearched >= searched_from;
  const MapExtent extent = extent_of(*map);
  if (other_frame) {
    merger_.update(*robot.id, *map);
  } else {
    merger_.grow(*robot.id, *map);
    if (searches) merger_.search_again(*robot.id);
  }
  if (searches) robot.searched = map;
  robot.map = std::move(map);
  robot.extent = extent;
  fresh_.insert(name);
  if (!other_frame) return;
  placements_.forget(name);
  told_robots_.erase(name);
  restarted_.insert(name);
}

void TeamSolver::remove(const std::string& name) {
  const auto robot = robots_.find(name);
  if (robot == robots_.end()) return;
  if (robot->second.id) {
    merger_.remove(*robot->second.id);
    names_.erase(*robot->second.id);
  }
  placements_.forget(name);
  left_out_.erase(name);
  fresh_.erase(name);
  restarted_.erase(name);
  told_robots_.erase(name);
  robots_.erase(robot);
}

bool TeamSolver::is_placed(const std::string& name) const {
  const auto& groups = placements_.groups();
  return std::any_of(groups.begin(), groups.end(),
                     [&](const RobotGroup& group) { return group.robots.contains(name); });
}

void TeamSolver::search_what_changed() {
  for (auto& [name, robot] : robots_) {
    if (!robot.id || robot.searched == robot.map) continue;
    merger_.search_again(*robot.id);
    robot.searched = robot.map;
  }
}

void TeamSolver::propose(const MergeResult& result, Placements::Weight weight) {
  std::vector<std::string> names;  // by place in the result
  for (const MapId id : merger_.maps()) names.push_back(names_.at(id));
  std::vector<RobotGroup> proposed;
  for (const Component& component : result.components) {
    RobotGroup group{{}, component.in_world_frame};
    for (const Member& member : component.members)
      group.robots[names[member.map]] = {member.T_component_map, member.probability.value_or(0.0)};
    const std::string& anchor = first_heard(group.robots);
    if (!group.in_world_frame && anchor != names[component.members.front().map]) {
      const SE2 T_anchor_component = inverse(group.robots.at(anchor).T_group_map);
      for (auto& [name, placement] : group.robots)
        placement.T_group_map = name == anchor ? SE2{} : T_anchor_component * placement.T_group_map;
    }
    proposed.push_back(std::move(group));
  }
  left_out_.clear();
  for (const LeftOut& one : result.left_out) left_out_[names[one.map]] = one.reason;
  std::map<std::string, MapExtent> extents;
  for (const auto& [name, robot] : robots_) {
    if (robot.id) extents[name] = robot.extent;
  }
  placements_.propose(std::move(proposed), fresh_, extents, weight);
  fresh_.clear();
}

void TeamSolver::tell_components(MergeResult result, TeamAnswer& answer) const {
  const std::vector<MapId> ids = merger_.maps();
  std::map<std::string, std::size_t> places;  // in the result
  for (std::size_t i = 0; i < ids.size(); ++i) places[names_.at(ids[i])] = i;
  struct Told {
    TeamComponent component;
    Component merged;
  };
  std::vector<Told> all;
  for (const RobotGroup& group : placements_.groups()) {
    Told told;
    if (!group.in_world_frame) told.component.anchor = first_heard(group.robots);
    std::vector<PlacedMap> placed;
    for (const auto& [name, placement] : group.robots) {
      told.component.robots.push_back(name);
      placed.push_back({robots_.at(name).map.get(), placement.T_group_map});
      told.merged.members.push_back({places.at(name), placement.T_group_map, placement.probability});
    }
    std::sort(told.merged.members.begin(), told.merged.members.end(),
              [](const Member& a, const Member& b) { return a.map < b.map; });
    // What the merger fused serves where the maps lie as it says.
    const auto same =
        std::find_if(result.components.begin(), result.components.end(), [&](const Component& one) {
          return std::equal(one.members.begin(), one.members.end(), told.merged.members.begin(),
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
  std::sort(all.begin(), all.end(), [](const Told& a, const Told& b) {
    return std::pair(b.component.robots.size(), a.component.robots) <
           std::pair(a.component.robots.size(), b.component.robots);
  });
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
  const std::vector<RobotGroup>& groups = placements_.groups();
  const auto group = std::find_if(groups.begin(), groups.end(),
                                  [&](const RobotGroup& one) { return one.robots.contains(name); });
  if (group != groups.end()) {
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
  for (const auto& [name, robot] : robots_) extents[name] = robot.extent;
  for (const std::string& name : restarted_)
    answer.events.push_back({TeamEvent::Kind::restarted, name, say_restarted(name)});
  std::vector<RobotGroup> before = told_;
  for (RobotGroup& group : before)
    std::erase_if(group.robots, [&](const auto& one) { return restarted_.contains(one.first); });
  for (TeamEvent& event : changes_between(before, placements_.groups(), extents))
    answer.events.push_back(std::move(event));
}

const std::string& TeamSolver::first_heard(const std::map<std::string, Placement>& robots) const {
  return std::min_element(robots.begin(), robots.end(),
                          [&](const auto& a, const auto& b) {
                            return std::pair(robots_.at(a.first).since, a.first) <
                                   std::pair(robots_.at(b.first).since, b.first);
                          })
      ->first;
}

}  // namespace gridmerge::internal
