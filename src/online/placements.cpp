// SPDX-License-Identifier: Apache-2.0
#include "online/placements.hpp"

#include <algorithm>
#include <iterator>
#include <optional>

#include "merge/disjoint_sets.hpp"

namespace gridmerge::internal {

namespace {

/// The group that holds a robot, by robot.
std::map<std::string, std::size_t> places_of(const std::vector<RobotGroup>& groups) {
  std::map<std::string, std::size_t> places;
  for (std::size_t i = 0; i < groups.size(); ++i) {
    for (const auto& [robot, placement] : groups[i].robots) places[robot] = i;
  }
  return places;
}

/// From the second robot's map frame to the first one's, where they lie together.
std::optional<SE2> between(const std::vector<RobotGroup>& groups,
                           const std::map<std::string, std::size_t>& places, const std::string& first,
                           const std::string& second) {
  const auto a = places.find(first), b = places.find(second);
  if (a == places.end() || b == places.end() || a->second != b->second) return std::nullopt;
  const auto& robots = groups[a->second].robots;
  return inverse(robots.at(first).T_group_map) * robots.at(second).T_group_map;
}

}  // namespace

const RobotGroup* group_of(const std::vector<RobotGroup>& groups, const std::string& robot) {
  const auto group = std::find_if(groups.begin(), groups.end(),
                                  [&](const RobotGroup& one) { return one.robots.contains(robot); });
  return group == groups.end() ? nullptr : &*group;
}

// What contradicted a pair that lies together no more is dropped by the next proposal.
void Placements::forget(const std::string& robot) {
  for (RobotGroup& group : groups_) group.robots.erase(robot);
  std::erase_if(groups_, [](const RobotGroup& group) { return group.robots.size() < 2; });
}

/// Robots that lie in no group of a partial proposal, but lay with some that do, lie there as they did.
void Placements::add_missing(std::vector<RobotGroup>& proposed) const {
  auto places = places_of(proposed);
  for (const RobotGroup& held : groups_) {
    std::map<std::size_t, std::size_t> companions;  // by proposed group
    for (const auto& [robot, placement] : held.robots) {
      if (const auto place = places.find(robot); place != places.end()) ++companions[place->second];
    }
    if (companions.empty()) {
      proposed.push_back(held);
      continue;
    }
    const std::size_t most =
        std::max_element(companions.begin(), companions.end(), [](const auto& a, const auto& b) {
          return a.second < b.second;
        })->first;
    const auto companion = std::find_if(held.robots.begin(), held.robots.end(), [&](const auto& one) {
      const auto place = places.find(one.first);
      return place != places.end() && place->second == most;
    });
    RobotGroup& group = proposed[most];
    const SE2 T_group_held =
        group.robots.at(companion->first).T_group_map * inverse(companion->second.T_group_map);
    for (const auto& [robot, placement] : held.robots) {
      if (places.contains(robot)) continue;
      group.robots[robot] = {T_group_held * placement.T_group_map, placement.probability};
      places[robot] = most;
    }
  }
}

void Placements::propose(std::vector<RobotGroup> proposed, const std::set<std::string>& fresh,
                         const std::map<std::string, MapExtent>& extents, Weight weight) {
  if (weight == Weight::partial) add_missing(proposed);
  const auto held = places_of(groups_), wanted = places_of(proposed);

  // Groups before and groups proposed that have a robot in common are taken or left together.
  DisjointSets clusters(groups_.size() + proposed.size());
  for (const auto& [robot, group] : wanted) {
    if (const auto before = held.find(robot); before != held.end())
      clusters.unite(before->second, groups_.size() + group);
  }
  std::set<std::size_t> has_fresh;
  for (const auto& [robot, group] : held) {
    if (fresh.contains(robot)) has_fresh.insert(clusters.least_of(group));
  }
  for (const auto& [robot, group] : wanted) {
    if (fresh.contains(robot)) has_fresh.insert(clusters.least_of(groups_.size() + group));
  }

  std::map<Pair, Contradiction> contradictions;
  std::set<std::size_t> contradicted, confirmed;  // clusters
  for (std::size_t i = 0; i < groups_.size(); ++i) {
    const std::size_t cluster = clusters.least_of(i);
    const auto& robots = groups_[i].robots;
    for (auto first = robots.begin(); first != robots.end(); ++first) {
      for (auto second = std::next(first); second != robots.end(); ++second) {
        const MapExtent &a = extents.at(first->first), &b = extents.at(second->first);
        const double tolerance = agreement_tolerance(a, b);
        const SE2 T_before = inverse(first->second.T_group_map) * second->second.T_group_map;
        const std::optional<SE2> T_now = between(proposed, wanted, first->first, second->first);
        if (T_now && difference(a, b, T_before, *T_now) <= tolerance) continue;
        Contradiction now{!T_now, T_now.value_or(SE2{}), 0};
        const auto known = contradictions_.find({first->first, second->first});
        if (known != contradictions_.end() && known->second.apart == now.apart &&
            (now.apart || difference(a, b, known->second.T_first_second, now.T_first_second) <= tolerance))
          now.times = known->second.times;
        if (has_fresh.contains(cluster) && (T_now || weight != Weight::partial)) ++now.times;
        contradicted.insert(cluster);
        if (weight == Weight::conclusive || now.times >= confirmations_) confirmed.insert(cluster);
        contradictions[{first->first, second->first}] = now;
      }
    }
  }

  std::vector<RobotGroup> next;
  is_held_back_ = false;
  const auto stays = [&](std::size_t group) {
    const std::size_t cluster = clusters.least_of(group);
    return contradicted.contains(cluster) && !confirmed.contains(cluster);
  };
  for (std::size_t i = 0; i < groups_.size(); ++i) {
    if (!stays(i)) continue;
    is_held_back_ = true;
    next.push_back(std::move(groups_[i]));
  }
  for (std::size_t i = 0; i < proposed.size(); ++i) {
    if (!stays(groups_.size() + i)) next.push_back(std::move(proposed[i]));
  }
  // What was confirmed is no contradiction any more.
  for (auto one = contradictions.begin(); one != contradictions.end();) {
    const bool is_over = confirmed.contains(clusters.least_of(held.at(one->first.first)));
    one = is_over ? contradictions.erase(one) : std::next(one);
  }
  contradictions_ = std::move(contradictions);
  groups_ = std::move(next);
}

}  // namespace gridmerge::internal
