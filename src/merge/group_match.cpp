// SPDX-License-Identifier: Apache-2.0
#include "group_match.hpp"

#include <algorithm>
#include <memory>
#include <optional>
#include <utility>

#include "candidates.hpp"
#include "gridmerge/grid/parallel.hpp"
#include "gridmerge/merge/fuse.hpp"
#include "gridmerge/similarity/agreement.hpp"
#include "join_weights.hpp"
#include "joins.hpp"

namespace gridmerge {

namespace {

/// A group of several maps and a map that lies alone.
struct Meeting {
  std::size_t group;
  std::size_t map;
};

std::unique_ptr<PreparedMap> prepare(const NodeGroup& group, const MergeInputs& inputs) {
  std::vector<PlacedMap> placed;
  for (const PlacedNode& node : group) placed.push_back({inputs.grids[node.map], node.T_group_map});
  return std::make_unique<PreparedMap>(fuse(placed, finest_resolution(placed)).grid);
}

/// The member that has most in common with a map.
const PlacedNode& nearest_member(const NodeGroup& group, std::size_t map, const SE2& T_group_map,
                                 const MergeInputs& inputs) {
  return *std::max_element(group.begin(), group.end(), [&](const PlacedNode& a, const PlacedNode& b) {
    const auto in_common = [&](const PlacedNode& node) {
      const OccupancyGrid &ours = inputs.prepared[map]->known(), &theirs = inputs.prepared[node.map]->known();
      const SE2 T_map_member = inverse(T_group_map) * node.T_group_map;
      return static_cast<double>(count_agreement(ours, theirs, T_map_member).both_known()) *
             theirs.resolution * theirs.resolution;
    };
    return in_common(a) < in_common(b);
  });
}

/// Puts candidates of the group in the place of those of its members.
void say(const MatchResult& match, const NodeGroup& group, std::size_t map, const MergeInputs& inputs,
         ArrangementProblem& problem) {
  const std::vector<CandidateJoin> candidates =
      candidate_joins(match);  // between the group's frame and the map
  const auto is_member = [&](std::size_t one) {
    return std::any_of(group.begin(), group.end(), [&](const PlacedNode& node) { return node.map == one; });
  };
  const PlacedNode& speaker = nearest_member(group, map, match.T_fixed_moving, inputs);
  for (PairCandidates& pair : problem.pairs) {
    const bool is_moving = pair.moving == map;
    if (!is_moving && pair.fixed != map) continue;
    const std::size_t other = is_moving ? pair.fixed : pair.moving;
    if (!is_member(other)) continue;
    const PlacedNode& member =
        *std::find_if(group.begin(), group.end(), [&](const PlacedNode& node) { return node.map == other; });
    pair.candidates = candidates;
    for (CandidateJoin& candidate : pair.candidates) {
      const SE2 T_member_map = inverse(member.T_group_map) * candidate.T_fixed_moving;
      candidate.T_fixed_moving = is_moving ? T_member_map : inverse(T_member_map);
      if (other != speaker.map) candidate.log_odds = -kPoseNats;  // worth nothing, and no loss
    }
  }
}

}  // namespace

GroupMatches::GroupMatches(const MatchOptions& options) : options_(options) {
  options_.progress = nullptr;
  options_.max_hypotheses = kKeptHypotheses;
}

ArrangementProblem GroupMatches::heard(const ArrangementProblem& problem, const Arrangement& arrangement,
                                       const MergeInputs& inputs) {
  const std::vector<NodeGroup>& groups = arrangement.groups;
  std::vector<Meeting> meetings;
  std::vector<Key> keys;
  for (std::size_t g = 0; g < groups.size(); ++g) {
    if (groups[g].size() < 2) continue;
    for (const NodeGroup& other : groups) {
      const std::size_t map = other.front().map;
      if (other.size() > 1 || inputs.known_poses[map]) continue;
      meetings.push_back({g, map});
      Key& key = keys.emplace_back(1, static_cast<double>(inputs.index[map]));
      for (const PlacedNode& node : groups[g]) {
        const SE2& T = node.T_group_map;
        key.insert(key.end(), {static_cast<double>(inputs.index[node.map]), T.x, T.y, T.theta});
      }
    }
  }
  std::vector<std::unique_ptr<PreparedMap>> prepared(groups.size());
  std::vector<const MatchResult*> known(meetings.size(), nullptr);
  std::vector<std::size_t> fresh;
  for (std::size_t i = 0; i < meetings.size(); ++i) {
    if (const auto kept = kept_.find(keys[i]); kept != kept_.end()) {
      known[i] = &kept->second;
      continue;
    }
    fresh.push_back(i);
    std::unique_ptr<PreparedMap>& group = prepared[meetings[i].group];
    if (!group) group = prepare(groups[meetings[i].group], inputs);
  }
  std::vector<MatchResult> found(fresh.size());
  parallel_for(fresh.size(), [&](std::size_t i) {
    const Meeting& meeting = meetings[fresh[i]];
    with_threads(
        1, [&] { found[i] = match(*prepared[meeting.group], *inputs.prepared[meeting.map], options_); });
  });
  std::map<Key, MatchResult> kept;
  for (std::size_t i = 0; i < fresh.size(); ++i) kept[keys[fresh[i]]] = std::move(found[i]);
  for (std::size_t i = 0; i < meetings.size(); ++i) {
    if (known[i] != nullptr) kept[keys[i]] = *known[i];
  }
  kept_ = std::move(kept);

  ArrangementProblem next = problem;
  for (std::size_t i = 0; i < meetings.size(); ++i) {
    const MatchResult& match = kept_.at(keys[i]);
    if (match.verdict == Verdict::accepted)
      say(match, groups[meetings[i].group], meetings[i].map, inputs, next);
  }
  return next;
}

}  // namespace gridmerge
