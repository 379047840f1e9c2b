// SPDX-License-Identifier: Apache-2.0
#include "merge/group_match.hpp"

#include <algorithm>
#include <memory>
#include <utility>
#include <vector>

#include "grid/parallel.hpp"
#include "gridmerge/merge/fuse.hpp"
#include "match/looked_twice.hpp"
#include "merge/candidates.hpp"
#include "merge/join_weights.hpp"
#include "merge/joins.hpp"
#include "similarity/agreement.hpp"

namespace gridmerge::internal {

namespace {

/// Among many maps, a group and a map get a thorough look if the quick one finds a pose of this probability.
/// That look is for maps that share little, and a group has seen much: of two campuses of 300 maps the quick
/// look accepted 18 meetings, and the thorough look none of the other 358.
constexpr double kWorthASecondLook = 0.1;

/// A group of several maps and a map that lies alone.
struct Meeting {
  std::size_t group;
  std::size_t map;
  std::vector<double> key;  // which maps of the group lie how, and which one meets them
};

std::unique_ptr<PreparedMap> prepare(const NodeGroup& group, const std::vector<MergeInput>& inputs) {
  std::vector<PlacedMap> placed;
  for (const PlacedNode& node : group) placed.push_back({inputs[node.map].grid, node.T_group_map});
  const double resolution = fitting_resolution(finest_resolution(placed), placed);
  return std::make_unique<PreparedMap>(fuse(placed, resolution).grid);
}

/// The member that has most in common with a map.
std::size_t nearest_member(const NodeGroup& group, std::size_t map, const SE2& T_group_map,
                           const std::vector<MergeInput>& inputs) {
  std::size_t nearest = group.front().map;
  double most = -1.0;
  for (const PlacedNode& node : group) {
    const OccupancyGrid &ours = inputs[map].prepared->known(), &theirs = inputs[node.map].prepared->known();
    const SE2 T_map_member = inverse(T_group_map) * node.T_group_map;
    const double in_common = static_cast<double>(count_agreement(ours, theirs, T_map_member).both_known()) *
                             theirs.resolution * theirs.resolution;
    if (in_common <= most) continue;
    most = in_common;
    nearest = node.map;
  }
  return nearest;
}

/// Puts candidates of the group in the place of those of its members.
void say(const MatchResult& match, const NodeGroup& group, std::size_t map,
         const std::vector<MergeInput>& inputs, JoinProblem& problem) {
  const std::vector<CandidateJoin> candidates = candidate_joins(match);  // of the group's frame and the map
  const std::size_t speaker = nearest_member(group, map, match.T_fixed_moving, inputs);
  const auto [first, second] = std::minmax(speaker, map);
  if (std::none_of(problem.pairs.begin(), problem.pairs.end(),
                   [first = first, second = second](const PairCandidates& pair) {
                     return pair.fixed == first && pair.moving == second;
                   }))
    problem.pairs.push_back({first, second, {}});  // nobody has looked at the two
  for (PairCandidates& pair : problem.pairs) {
    const bool is_moving = pair.moving == map;
    if (!is_moving && pair.fixed != map) continue;
    const std::size_t other = is_moving ? pair.fixed : pair.moving;
    const auto member =
        std::find_if(group.begin(), group.end(), [&](const PlacedNode& node) { return node.map == other; });
    if (member == group.end()) continue;
    pair.candidates = candidates;
    for (CandidateJoin& candidate : pair.candidates) {
      const SE2 T_member_map = inverse(member->T_group_map) * candidate.T_fixed_moving;
      candidate.T_fixed_moving = is_moving ? T_member_map : inverse(T_member_map);
      if (other != speaker) candidate.log_odds = kSaysNothing;
    }
  }
}

}  // namespace

GroupMatches::GroupMatches(MatchOptions options) : options_(std::move(options)) {
  options_.progress = nullptr;
  options_.max_hypotheses = kKeptHypotheses;
}

JoinProblem GroupMatches::heard(const JoinProblem& problem, const ConsistentSet& consistent_set,
                                const std::vector<MergeInput>& inputs, const WorthMeeting& worth_meeting) {
  const std::vector<NodeGroup>& groups = consistent_set.groups;
  std::vector<std::pair<std::size_t, std::size_t>> all;
  std::vector<std::size_t> meeting_groups;
  for (std::size_t g = 0; g < groups.size(); ++g) {
    if (groups[g].size() < 2) continue;
    const std::size_t before = all.size();
    for (const NodeGroup& other : groups) {
      if (other.size() == 1 && !inputs[other.front().map].known_pose) all.emplace_back(g, other.front().map);
    }
    if (all.size() > before) meeting_groups.push_back(g);
  }
  std::vector<std::unique_ptr<PreparedMap>> prepared(groups.size());
  if (worth_meeting) {
    parallel_for(meeting_groups.size(), [&](std::size_t i) {
      prepared[meeting_groups[i]] = prepare(groups[meeting_groups[i]], inputs);
    });
    const std::vector<bool> is_worth = worth_meeting(prepared, all);
    std::vector<std::pair<std::size_t, std::size_t>> worth;
    for (std::size_t i = 0; i < all.size(); ++i) {
      if (is_worth[i]) worth.push_back(all[i]);
    }
    all = std::move(worth);
  }
  const bool is_thorough = !worth_meeting || options_.search != SearchMethod::exhaustive;
  std::vector<Meeting> meetings;
  for (const auto& [g, map] : all) {
    Key key{static_cast<double>(inputs[map].index), is_thorough ? 1.0 : 0.0};
    for (const PlacedNode& node : groups[g]) {
      const SE2& T = node.T_group_map;
      key.insert(key.end(), {static_cast<double>(inputs[node.map].index), T.x, T.y, T.theta});
    }
    meetings.push_back({g, map, std::move(key)});
  }
  std::map<Key, MatchResult> needed;
  std::vector<std::pair<const Meeting*, MatchResult*>> fresh;
  for (const Meeting& meeting : meetings) {
    MatchResult& result = needed[meeting.key];
    if (const auto kept = kept_.find(meeting.key); kept != kept_.end()) {
      result = kept->second;
      continue;
    }
    fresh.emplace_back(&meeting, &result);
    std::unique_ptr<PreparedMap>& group = prepared[meeting.group];
    if (!group) group = prepare(groups[meeting.group], inputs);
  }
  parallel_tasks(fresh.size(), [&](std::size_t i) {
    const auto& [meeting, result] = fresh[i];
    const PreparedMap &group = *prepared[meeting->group], &map = *inputs[meeting->map].prepared;
    *result = is_thorough ? match(group, map, options_)
                          : match_if_promising(group, map, options_, kWorthASecondLook);
  });
  kept_ = std::move(needed);

  JoinProblem next = problem;
  for (const Meeting& meeting : meetings) {
    const MatchResult& match = kept_.at(meeting.key);
    if (match.verdict == Verdict::accepted) say(match, groups[meeting.group], meeting.map, inputs, next);
  }
  return next;
}

}  // namespace gridmerge::internal
