// SPDX-License-Identifier: Apache-2.0
#include "online/solver.hpp"

#include <algorithm>
#include <chrono>
#include <stdexcept>
#include <utility>

#include "grid/equal_grids.hpp"
#include "gridmerge/grid/execution.hpp"
#include "gridmerge/grid/resample.hpp"
#include "online/robot_map.hpp"

namespace gridmerge::internal {

namespace {

/// A robot that lies nowhere yet is searched for sooner: it is waited for.
constexpr double kSooner = 0.25;
/// Thorough looks until the next answer, which newer maps may wait for: a second or two on two cores.
constexpr std::size_t kPairsAtATime = 4;
/// A placed map is drawn where it lies if a smaller share of its cells, and of its walls, has changed since
/// it was weighed. A pose is a mean over walls: walls that are off by half a metre move it by a centimetre
/// then.
constexpr double kDrawnOnly = 0.02;

MergeOptions without_progress(MergeOptions options) {
  options.progress = nullptr;
  return options;
}

}  // namespace

void add_news(RobotNews& earlier, RobotNews later) {
  if (later.is_gone) {  // with all that was heard before: later news begin anew
    earlier = RobotNews{};
    earlier.is_gone = true;
  }
  if (later.known_pose) {
    earlier.known_pose = later.known_pose;
    earlier.map_of_pose = later.map_of_pose ? std::move(later.map_of_pose) : earlier.map;
  }
  if (later.map) earlier.map = std::move(later.map);
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

TeamSolver::Weighed TeamSolver::to_be_weighed(std::shared_ptr<const OccupancyGrid> map) {
  Weighed weighed;
  weighed.counts = count_cells(*map);
  if (weighed.counts.known() > 0) weighed.extent = Coverage(crop_to_known(*map)).extent();
  weighed.map = std::move(map);
  return weighed;
}

TeamAnswer TeamSolver::solve(Effort effort) {
  const auto start = std::chrono::steady_clock::now();
  TeamAnswer answer;
  bool differs = true;
  try {
    with_threads(options_.merge.match.threads, [&] { differs = find_out(effort, answer); });
  } catch (const Cancelled&) {
    throw;
  } catch (const std::exception& error) {  // a merged map would be too large, or there is no memory for it
    answer = answer_before();
    answer.problem = error.what();
    has_problem_ = true;
  }
  answer.settled = answer.problem.empty() && is_settled();
  if (differs || answer.settled != told_settled_) ++answers_;
  told_settled_ = answer.settled;
  answer.number = answers_;
  answer.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return answer;
}

/// Whether the answer differs from the one before in more than how often robots were heard.
bool TeamSolver::find_out(Effort effort, TeamAnswer& answer) {
  while (!pending_.empty()) {
    // In the order of their names; each is done with before it is forgotten.
    const auto next = pending_.begin();
    apply(next->first, next->second);
    pending_.erase(next);
  }
  if (effort == Effort::soon && is_weighed_) {
    draw_again(answer);
  } else {
    weigh_again(effort, answer);
  }
  for (const auto& [name, robot] : robots_) answer.robots.push_back(status_of(name, robot, answer));
  tell_events(answer);
  const auto is_as_told = [](const RobotStatus& robot, const auto& told) {
    RobotStatus before = told.second;
    before.maps_heard = robot.maps_heard;
    return robot == before;
  };
  const bool differs = has_problem_ || !answer.events.empty() || answer.merge != told_merge_ ||
                       !std::equal(answer.robots.begin(), answer.robots.end(), told_robots_.begin(),
                                   told_robots_.end(), is_as_told);
  told_ = placements_.groups();
  told_components_ = answer.components;
  numbers_.keep(told_components_, ages());
  told_merge_ = answer.merge;
  told_robots_.clear();
  for (const RobotStatus& robot : answer.robots) told_robots_[robot.name] = robot;
  restarted_.clear();
  lost_poses_.clear();
  is_weighed_ = true;
  has_problem_ = false;
  return differs;
}

void TeamSolver::weigh_again(Effort effort, TeamAnswer& answer) {
  is_weighed_ = false;  // until that is done
  const bool in_full = effort == Effort::full;
  if (effort != Effort::further) weigh_what_changed();
  if (in_full) search_what_changed();
  MergeResult result =
      in_full ? merger_.solve() : merger_.solve_soon(effort == Effort::soon ? 0 : kPairsAtATime);
  using Weight = Placements::Weight;
  propose(result, in_full ? Weight::conclusive : is_complete() ? Weight::full : Weight::partial);
  tell_components(std::move(result), answer);
}

bool TeamSolver::is_settled() const {
  if (!is_weighed_ || !pending_.empty() || placements_.is_held_back() || !is_complete()) return false;
  return std::all_of(robots_.begin(), robots_.end(),
                     [](const auto& robot) { return robot.second.map == robot.second.searched; });
}

void TeamSolver::apply(const std::string& name, RobotNews& news) {
  if (news.is_gone) {
    remove(name);
    news.is_gone = false;
  }
  if (news.since) {
    Robot& robot = robots_.try_emplace(name, Robot{}).first->second;
    if (*news.since < robot.since) is_weighed_ = false;  // frames follow from who was heard first
    robot.since = std::min(robot.since, *news.since);
  }
  if (news.map_of_pose) {
    set_map(name, news.map_of_pose);
    news.map_of_pose.reset();
  }
  if (news.known_pose) {
    Robot& robot = robots_.try_emplace(name, Robot{}).first->second;
    robot.known_pose = *news.known_pose;
    if (robot.id) merger_.set_known_pose(*robot.id, robot.known_pose);
    if (robot.known_pose) lost_poses_.erase(name);  // it has another one
    placements_.forget(name);
    is_weighed_ = false;
    news.known_pose.reset();
  }
  if (news.map) set_map(name, news.map);
  if (const auto robot = robots_.find(name); robot != robots_.end())
    robot->second.maps_heard += news.maps_heard;
}

void TeamSolver::set_map(const std::string& name, std::shared_ptr<const OccupancyGrid> map) {
  Robot& robot = robots_[name];
  if (!robot.id) {
    Weighed weighed = to_be_weighed(map);
    begin_to_weigh(name);
    const MapId id = merger_.add(*map, robot.known_pose);
    try {
      names_[id] = name;
    } catch (...) {
      merger_.remove(id);
      throw;
    }
    robot.id = id;
    robot.map = robot.searched = std::move(map);
    robot.weighed = std::move(weighed);
    return;
  }
  if (are_equal(*robot.map, *map)) return;
  if (robot.map != robot.weighed.map && are_equal(*robot.weighed.map, *map)) {  // a change was taken back
    robot.map = robot.weighed.map;
  } else if (is_drawn_only(name, robot, *map)) {
    robot.map = std::move(map);
  } else {
    weigh(name, robot, std::move(map));
  }
}

/// Whether the pose stays. While one is contradicted, what confirms that has to be weighed.
bool TeamSolver::is_drawn_only(const std::string& name, const Robot& robot, const OccupancyGrid& map) const {
  if (!is_placed(name) || placements_.is_held_back() || may_lie_with_copies(name)) return false;
  const std::optional<ChangedCells> changed = count_changed_cells(*robot.weighed.map, map);
  if (!changed) return false;
  const double share = std::min(kDrawnOnly, options_.search_again);
  const auto is_little = [&](std::size_t changed_cells, std::size_t cells) {
    return static_cast<double>(changed_cells) < share * static_cast<double>(cells);
  };
  if (!is_little(changed->all, robot.weighed.counts.known())) return false;
  if (changed->walls > 0 && !is_little(changed->walls, robot.weighed.counts.occupied)) return false;
  return robot.searched == robot.weighed.map ||
         change_between(*robot.searched, map).share < options_.search_again;
}

/// Of equal maps one counts, as the merger finds them: it has to see each change of those that lie with them.
bool TeamSolver::may_lie_with_copies(const std::string& name) const {
  const RobotGroup* const group = group_of(placements_.groups(), name);
  if (group == nullptr) return false;
  std::set<std::size_t> known_cells;
  for (const auto& [robot, placement] : group->robots)
    known_cells.insert(robots_.at(robot).weighed.counts.known());
  return known_cells.size() < group->robots.size();
}

/// Gives the merger the robot's newest map. May be cancelled: but for begin_to_weigh() all is as before then.
void TeamSolver::weigh(const std::string& name, Robot& robot, std::shared_ptr<const OccupancyGrid> map) {
  const MapChange change = change_between(*robot.weighed.map, *map);
  const double searched_from = options_.search_again * (is_placed(name) ? 1.0 : kSooner);
  // Mostly the map before is the one that was searched last.
  const double unsearched =
      robot.searched == robot.weighed.map ? change.share : change_between(*robot.searched, *map).share;
  const bool searches = change.other_frame || unsearched >= searched_from;
  const bool loses_pose = change.other_frame && robot.known_pose && !keeps_walls(*robot.weighed.map, *map);
  Weighed weighed = to_be_weighed(map);
  begin_to_weigh(name);
  if (change.other_frame) {
    merger_.update(*robot.id, *map);
    restarted_.insert(name);
    if (loses_pose) {  // it was that of a frame which is no more
      lost_poses_.insert(name);
      robot.known_pose.reset();
      merger_.set_known_pose(*robot.id, std::nullopt);
    }
    placements_.forget(name);
    told_robots_.erase(name);
  } else {
    merger_.grow(*robot.id, *map);
    if (searches) merger_.search_again(*robot.id);
  }
  if (searches) robot.searched = map;
  robot.map = std::move(map);
  robot.weighed = std::move(weighed);
}

/// Whatever ends it early: poses may follow from another map of the robot's now.
void TeamSolver::begin_to_weigh(const std::string& name) {
  is_weighed_ = false;
  fresh_.insert(name);
}

void TeamSolver::weigh_what_changed() {
  for (auto& [name, robot] : robots_) {
    if (robot.map != robot.weighed.map) weigh(name, robot, robot.map);
  }
}

void TeamSolver::remove(const std::string& name) {
  const auto robot = robots_.find(name);
  if (robot == robots_.end()) return;
  if (robot->second.id) {
    merger_.remove(*robot->second.id);
    names_.erase(*robot->second.id);
  }
  placements_.forget(name);
  restarted_.erase(name);
  lost_poses_.erase(name);
  told_robots_.erase(name);
  robots_.erase(robot);
  is_weighed_ = false;
}

bool TeamSolver::is_placed(const std::string& name) const {
  return group_of(placements_.groups(), name) != nullptr;
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
    if (robot.id) extents[name] = robot.weighed.extent;
  }
  placements_.propose(std::move(proposed), fresh_, extents, weight);
  fresh_.clear();
}

}  // namespace gridmerge::internal
